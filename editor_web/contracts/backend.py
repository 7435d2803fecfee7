"""Protocols of the engine as the dashboard uses it: behaviors, runs, events and topics of the cell.

They are structural: the engine's frozen structs satisfy them by having the same attributes, so `engine` imports
nothing from here. All calls come from the event loop's thread.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from editor_web.contracts.run_operations import RunOperations
from engine.archive import Archive
from engine.bus.json_bus import JsonBus
from engine.editing import DocumentRepository
from engine.event import Event
from engine.project.bus_inspector import BusInspector
from engine.project.run_factory import RunPosition
from engine.runtime.control import ControlView
from engine.runtime.history.userdata_history import UserdataHistory
from engine.runtime.run_options import RunOptions

Unsubscribe = Callable[[], None]


class FindingLike(Protocol):
    """One problem of a document, as `flexcell check` prints it."""

    @property
    def severity(self) -> str:
        """`error` (prevents a run) or `warning`."""
        ...

    @property
    def code(self) -> str:
        """Stable short name of the rule, `unknown-state`."""
        ...

    @property
    def message(self) -> str:
        """The problem, in one line."""
        ...

    @property
    def path(self) -> str:
        """Path of the affected node, `root/approach/left`; empty for the whole document."""
        ...

    @property
    def line(self) -> int:
        """Line in the document, from 1."""
        ...

    @property
    def column(self) -> int:
        """Column in the document, from 1."""
        ...

    @property
    def hint(self) -> str:
        """How to fix it; may be empty."""
        ...


class ParameterLike(Protocol):
    """One parameter of a run."""

    @property
    def name(self) -> str:
        """The key under `parameters:`."""
        ...

    @property
    def schema(self) -> Mapping[str, object]:
        """JSON Schema of the value: type, minimum, maximum, enum, default, description, `title` (label), `unit`."""
        ...

    @property
    def required(self) -> bool:
        """True when it has no default."""
        ...


class TransitionLike(Protocol):
    """A transition inside a machine: when `source` ends with `outcome`, `target` is next."""

    @property
    def source(self) -> str:
        """Name of a child."""
        ...

    @property
    def outcome(self) -> str:
        """An outcome of that child."""
        ...

    @property
    def target(self) -> str:
        """Name of a child, or an outcome of the machine itself."""
        ...


class GraphNodeLike(Protocol):
    """One node of the behavior with everything inside it."""

    @property
    def path(self) -> str:
        """`root/approach/left`: the path that events carry."""
        ...

    @property
    def name(self) -> str:
        """Last part of the path."""
        ...

    @property
    def kind(self) -> str:
        """`state`, `machine`, `concurrency` or `behavior`; unknown kinds are drawn as a plain container."""
        ...

    @property
    def title(self) -> str:
        """State name, `motion.MoveJoints`, or the referenced behavior; empty for containers."""
        ...

    @property
    def outcomes(self) -> tuple[str, ...]:
        """All possible outcomes."""
        ...

    @property
    def children(self) -> tuple[GraphNodeLike, ...]:
        """The nodes inside, in document order."""
        ...

    @property
    def transitions(self) -> tuple[TransitionLike, ...]:
        """The transitions between the children; empty unless it is a machine."""
        ...

    @property
    def initial(self) -> str | None:
        """Name of the initial child of a machine."""
        ...

    @property
    def conditions(self) -> tuple[str, ...]:
        """The rules of a concurrency container as text, `finished: left=reached and right=reached`."""
        ...


class BehaviorSummaryLike(Protocol):
    """One line of the list of behaviors."""

    @property
    def id(self) -> str:
        """Path of the document relative to the project, with forward slashes."""
        ...

    @property
    def name(self) -> str:
        """The document's `name:`; the file name if the document cannot be read."""
        ...

    @property
    def description(self) -> str:
        """The document's `description:`; may be empty."""
        ...

    @property
    def errors(self) -> int:
        """Number of findings that prevent a run."""
        ...

    @property
    def warnings(self) -> int:
        """Number of findings that do not prevent a run."""
        ...


class BehaviorDetailLike(BehaviorSummaryLike, Protocol):
    """One behavior with its form, findings and graph."""

    @property
    def parameters(self) -> tuple[ParameterLike, ...]:
        """In document order."""
        ...

    @property
    def findings(self) -> tuple[FindingLike, ...]:
        """Sorted by line."""
        ...

    @property
    def graph(self) -> GraphNodeLike | None:
        """The root node; None if the document cannot be read."""
        ...

    @property
    def view(self) -> Mapping[str, tuple[float, float]]:
        """Canvas positions by node path, in pixels relative to the parent node; may be empty."""
        ...

    @property
    def success(self) -> tuple[str, ...]:
        """The outcomes that mean success."""
        ...


class RunSummaryLike(Protocol):
    """One run, active or ended."""

    @property
    def id(self) -> str:
        """The run's id."""
        ...

    @property
    def behavior(self) -> str:
        """Id of its behavior."""
        ...

    @property
    def status(self) -> str:
        """`running`, `stopping`, `finished`, `stopped` or `errored`."""
        ...

    @property
    def outcome(self) -> str | None:
        """Outcome of a finished run."""
        ...

    @property
    def success(self) -> bool:
        """True if it finished with an outcome that means success."""
        ...

    @property
    def cause(self) -> str:
        """Why it failed, in one line; empty otherwise."""
        ...

    @property
    def started_at_s(self) -> float:
        """Wall time of the start, seconds since 1970."""
        ...

    @property
    def duration_s(self) -> float:
        """Duration on the run's own clock; the elapsed time while it is active."""
        ...

    @property
    def control(self) -> ControlView | None:
        """The operator's view while the run is active; None after its end."""
        ...


class Backend(RunOperations, Protocol):
    """The engine as the dashboard sees it."""

    @property
    def cell_name(self) -> str:
        """Name of the connected cell, for the title; may be empty."""
        ...

    @property
    def documents(self) -> DocumentRepository:
        """The behaviors of the project as editable files."""
        ...

    @property
    def archive(self) -> Archive:
        """The past runs and recordings of the project."""
        ...

    @property
    def bus(self) -> JsonBus:
        """The skill bus as JSON, for the command line."""
        ...

    @property
    def desk(self) -> BusInspector:
        """The inspector of the skill bus, for the page."""
        ...

    def behaviors(self) -> tuple[BehaviorSummaryLike, ...]:
        """Return all behaviors of the project, sorted by id; an unreadable one is listed with its errors."""
        ...

    def behavior(self, behavior_id: str) -> BehaviorDetailLike:
        """Return one behavior; raises FlexcellError if there is none with this id."""
        ...

    def runs(self) -> tuple[RunSummaryLike, ...]:
        """Return the known runs, newest first; at most a few hundred."""
        ...

    def run(self, run_id: str) -> RunSummaryLike:
        """Return one run; raises FlexcellError if there is none with this id."""
        ...

    async def start(
        self,
        behavior_id: str,
        *,
        parameters: Mapping[str, object],
        seed: int,
        inputs: Mapping[str, object] | None = None,
        supervision: RunOptions | None = None,
        breakpoints: bool = False,
        begin: RunPosition | None = None,
    ) -> str:
        """Start a run and return its id.

        `breakpoints` enables the breakpoints stored with the behavior; `begin` starts from a position of a past run.

        Raises:
            FlexcellError: the run cannot start; `where` is the name of the invalid parameter, if there is one.
        """
        ...

    async def stop(self, run_id: str, *, reason: str) -> None:
        """Request the stop of a run and return at once; no effect on a run that has ended."""
        ...

    def subscribe(self, callback: Callable[[str, Event], None]) -> Unsubscribe:
        """Call `callback` with (run id, event) for every event of every run, on the event loop's thread."""
        ...

    def events(self, run_id: str, *, after: int = 0) -> list[Event]:
        """Return the events of a run with `seq` > `after`, in order."""
        ...

    def userdata(self, run_id: str) -> UserdataHistory:
        """Return the userdata history of a run before its first event; raises FlexcellError."""
        ...

    def recording_files(self, run_id: str) -> tuple[Path, ...]:
        """Return the recordings of a run, active or ended, oldest first; `run_id` may be the path of a recording.

        May be called on any thread.
        """
        ...

    def latest(self, topic: str) -> object | None:
        """Return the newest message of a bus topic, or None."""
        ...

    def subscribe_topic(self, topic: str, callback: Callable[[object], None]) -> Unsubscribe:
        """Call `callback` with the latest message of a topic at once, then with every new one, on the loop's thread.

        Raises:
            FlexcellError: this cell has no such topic.
        """
        ...

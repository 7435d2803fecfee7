"""A run as it is requested: what is executed, with which values, and from which event of another run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

import msgspec

from engine.check import check_given, require_no_errors
from engine.document import Behavior
from engine.document.cell import Cell
from engine.document.faults import Faults
from engine.errors import ControlError
from engine.recording import RecordedDocuments
from engine.recording.recorded_run import RecordedRun
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.resume import last_entered_state, read_history, start_checkpoint
from engine.runtime.plan import Catalogue, Plan
from engine.runtime.run_options import RunOptions


class RunPosition(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An event of a run in the journal; `path` is the node to start at, by default the state entered last."""

    run: str
    seq: Annotated[int, msgspec.Meta(ge=1)]
    path: str | None = None


@dataclass(frozen=True, kw_only=True)
class RunStart:
    """The data of a recorded run at one of its events, with which a new run starts."""

    recorded: RecordedRun
    seq: int
    checkpoint: Checkpoint

    @property
    def knows_world(self) -> bool:
        """Whether the state of the simulated world is known at that event."""
        return self.recorded.knows_world_at(self.seq)

    def parameters(self, plan: Plan, given: Mapping[str, object]) -> dict[str, object]:
        """Return the parameters of the new run: those given, else those of the recorded run."""
        known = {name: value for name, value in self.checkpoint.parameters.items() if name in plan.parameters}
        return {**known, **given}


@dataclass(frozen=True, kw_only=True)
class RunRequest:
    """Everything that decides a new run, read and checked before it starts; `CellRunner.start` starts it."""

    plan: Plan
    """What is executed; the behavior that it was built from goes to journal and recording."""
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    """Values for the behavior's parameters."""
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    """Initial values of userdata keys."""
    seed: int = 0
    """Seed of its random numbers, and of faults with a probability."""
    supervision: RunOptions = field(default_factory=RunOptions)
    """Operator, autonomy, breakpoints, time-outs."""
    faults: Faults | None = None
    """Faults that are injected into this run only."""
    start: RunStart | None = None
    """The event of another run to start from; by default it starts at the beginning."""
    restore_world: bool = False
    """Whether the simulated world is first restored to that event; no other run may be active."""
    documents: RecordedDocuments | None = None
    """Documents kept in its recording; without them it is not recorded."""
    source: str | None = None
    """Name of the behavior, if its file alone does not identify it: `FILE.py:NAME`."""
    run_id: str | None = None
    """Its id, by default a new one; events of two runs can only be equal where their ids are."""


def start_at(found: RecordedRun, plan: Plan, *, seq: int, path: str | None = None) -> RunStart:
    """Return the data of a run at one of its events, to start a new run with.

    Args:
        found: The run.
        plan: The plan of the new run; it may be another version.
        seq: The event whose data it uses.
        path: The node it starts at; by default the state that was entered last.

    Raises:
        DocumentError: the run has no such event, or had not entered a state by then.
        ControlError: a run cannot start at this node.
    """
    found.require_event(seq)
    history = read_history(plan, found.id, found.events, until_seq=seq)
    checkpoint = start_checkpoint(history, plan, path or last_entered_state(found.effective, seq))
    return RunStart(recorded=found, seq=seq, checkpoint=checkpoint)


def require_simulation(plan: Plan, cell: Cell | None, *, allowed: bool = False) -> None:
    """Reject substitutes in a cell with real robots, unless they are explicitly allowed.

    Raises:
        ControlError: a robot is real.
    """
    robots = cell.document.robots if cell is not None else {}
    real = [name for name, entry in robots.items() if not entry.simulated]
    if plan.stood_in_for and real and not allowed:
        raise ControlError(
            f"{plan.stood_in_for[0]} has a substitute, but {real[0]} is a real robot",
            where=plan.name,
            hint="run it in a simulated cell, or allow it with `--substitute-on-robots`",
        )


def require_names(behavior: Behavior, catalogue: Catalogue, cell: Cell, parameters: Mapping[str, object]) -> None:
    """Reject a run that names objects which its cell does not have.

    Args:
        behavior: The behavior.
        catalogue: The states by name.
        cell: The open cell.
        parameters: The parameters of the run.

    Raises:
        DocumentError: a robot, part, frame or other object is not in the cell; `where` is the position.
    """
    require_no_errors(check_given(behavior, catalogue, cell, parameters))

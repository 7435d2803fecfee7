"""A run as it is requested: what is executed, with which values, and from which event of another run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Annotated

import msgspec

from engine.check import check_given, require_no_errors
from engine.document import Behavior
from engine.document.cell import Cell
from engine.document.faults import Faults
from engine.errors import ControlError, FlexcellError
from engine.journal import list_runs
from engine.recording import RecordedDocuments
from engine.recording.recorded_run import RecordedRun, read_run
from engine.runtime.control import Breakpoint
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.resume import last_entered_state, last_entry, read_history, start_checkpoint
from engine.runtime.plan import Catalogue, Plan
from engine.runtime.run_options import RunOptions
from engine.wording.suggestions import did_you_mean

_LOOKED_AT = 20
"""Earlier runs in which the entry of a node is looked for."""


class RunPosition(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where a run starts: at the node `path`, with the data of event `seq` of a run in the journal.

    Without `run`, it starts with the initial userdata. Without `path`, at the state entered last.
    """

    run: str = ""
    seq: Annotated[int, msgspec.Meta(ge=1)] | None = None
    path: str | None = None


class StartData(msgspec.Struct, frozen=True, kw_only=True):
    """The data with which a run can start at a node: of the last run that entered it, else the initial values.

    `run` is empty where no run has; `seq` is the event before its entry. `obstacle` tells why a run cannot start there.
    """

    run: str = ""
    seq: int | None = None
    started_unix_s: float = 0.0
    parameters: dict[str, object]
    userdata: dict[str, object]
    obstacle: str = ""


@dataclass(frozen=True, kw_only=True)
class RunStart:
    """The data with which a new run starts at a node: of a recorded run at one of its events, or the initial values."""

    checkpoint: Checkpoint
    recorded: RecordedRun | None = None
    seq: int = 0

    @property
    def knows_world(self) -> bool:
        """Whether the state of the simulated world is known at that event."""
        return self.recorded is not None and self.recorded.knows_world_at(self.seq)

    def parameters(self, plan: Plan, given: Mapping[str, object]) -> dict[str, object]:
        """Return the parameters of the new run: those given, else those of the recorded run."""
        known = {name: value for name, value in self.checkpoint.parameters.items() if name in plan.parameters}
        return {**known, **given}

    def with_userdata(self, plan: Plan, given: Mapping[str, object]) -> RunStart:
        """Return the start with other values of userdata keys of the behavior.

        Raises:
            DocumentError: the behavior does not declare such a key.
        """
        userdata = {**self.checkpoint.userdata, **plan.checked_inputs(given)}
        return replace(self, checkpoint=replace(self.checkpoint, userdata=userdata))


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


def start_without_run(plan: Plan, path: str) -> RunStart:
    """Return a start at a node with the initial values of userdata.

    Raises:
        ControlError: a run cannot start at this node.
    """
    return RunStart(checkpoint=start_checkpoint(read_history(plan, "", ()), plan, path))


def start_of(place: Path | str, begin: RunPosition, plan: Plan, cell: Cell | None) -> RunStart:
    """Return the start at a position: of a run of the journal in `place`, or with the initial values.

    Raises:
        FlexcellError: there is no such run or event, or a run cannot start there.
    """
    if begin.run and begin.seq is not None:
        found = read_run(place, begin.run)
        require_no_new_real_devices(found, cell)
        return start_at(found, plan, seq=begin.seq, path=begin.path)
    if begin.run or begin.path is None:
        hint = "give `path` without `run`, or both `run` and `seq`"
        raise ControlError("this is no place to start at", where=begin.run or plan.name, hint=hint)
    return start_without_run(plan, begin.path)


def start_data(place: Path | str, plan: Plan, path: str) -> StartData:
    """Return the data with which a run can start at a node: of the last run of the journal that entered it."""
    known = [each for each in reversed(list_runs(place)) if each.behavior == plan.name and not each.damage]
    return latest_entry(plan, (read_run(place, each.id) for each in known[:_LOOKED_AT]), path)


def latest_entry(plan: Plan, runs: Iterable[RecordedRun], path: str) -> StartData:
    """Return the data that the first of the runs had which entered a node, just before its last entry.

    Args:
        plan: The behavior that is to start at the node.
        runs: Earlier runs, the newest first.
        path: The node.
    """
    for found in runs:
        entered = last_entry(found.effective, path)
        if entered > 1:
            seq = entered - 1
            values = read_history(plan, found.id, found.events, until_seq=seq).userdata()
            return StartData(
                run=found.id,
                seq=seq,
                started_unix_s=found.record.started_unix_s,
                parameters=dict(found.origin.parameters),
                userdata={key: value for key, value in values.items() if key in plan.userdata},
                obstacle=_obstacle(partial(start_at, found, plan, seq=seq, path=path)),
            )
    values = {name: each.default for name, each in plan.parameters.items() if not each.required}
    obstacle = _obstacle(partial(start_without_run, plan, path))
    return StartData(parameters=values, userdata=dict(plan.userdata), obstacle=obstacle)


def _obstacle(start: Callable[[], RunStart]) -> str:
    try:
        start()
    except FlexcellError as error:
        return f"{error.message} ({error.hint})" if error.hint else error.message
    return ""


def paused_before(plan: Plan, options: RunOptions, path: str | None) -> RunOptions:
    """Return the options of a run that pauses once before the node at `path`; the same for None.

    Raises:
        ControlError: no run enters such a node.
    """
    if path is None:
        return options
    node = plan.nodes.get(path)
    if node is None:
        hint = did_you_mean(path, plan.nodes)
        raise ControlError("no run enters this node: it does not exist, or is a part of a tree", where=path, hint=hint)
    if node.disabled is not None:
        raise ControlError("no run enters this node: it is disabled", where=path, hint="choose the next node")
    return msgspec.structs.replace(options, breakpoints=(*options.breakpoints, Breakpoint(path=path, once=True)))


def require_simulation(plan: Plan, cell: Cell | None, *, allowed: bool = False) -> None:
    """Reject substitutes in a cell with real robots, unless they are explicitly allowed.

    Raises:
        ControlError: a robot is real.
    """
    real = tuple(cell.document.real_devices) if cell is not None else ()
    if plan.stood_in_for and real and not allowed:
        raise ControlError(
            f"{plan.stood_in_for[0]} has a substitute, but {real[0]} is real",
            where=plan.name,
            hint="run it in a simulated cell, or allow it with `--substitute-on-robots`",
        )


def require_same_devices(found: RecordedRun, cell: Cell | None) -> None:
    """Refuse to resume a run where other devices are simulated: what was simulated must not go on with real arms.

    Raises:
        ControlError: a device was simulated and is real now, or the other way round.
    """
    require_no_new_real_devices(found, cell)
    before, now = set(found.origin.simulated), set(cell.simulated) if cell is not None else set[str]()
    if before == now:
        return
    word, names = ("simulated", before - now) if before - now else ("real", now - before)
    hint = "switch it in the page, or serve the cell with " + (
        " ".join(f"--simulate {name}" for name in sorted(before)) if before else "no `--simulate`"
    )
    raise ControlError(f"{', '.join(sorted(names))} was {word} in this run", where=found.id, hint=hint)


def require_no_new_real_devices(found: RecordedRun, cell: Cell | None) -> None:
    """Refuse to go on where a device is real that was not: its document, or that of another cell, names a driver now.

    Raises:
        ControlError: a device was simulated and is real now.
    """
    if cell is None or found.origin.real is None:
        return
    names = sorted(set(cell.document.real_devices) - set(found.origin.real))
    if names:
        hint = "simulate it with " + " ".join(f"`--simulate {name}`" for name in names) + ", or start a new run"
        raise ControlError(f"{', '.join(names)} was simulated in this run, and is real now", where=found.id, hint=hint)


def require_names(behavior: Behavior, catalogue: Catalogue, cell: Cell, parameters: Mapping[str, object]) -> None:
    """Reject a run whose parameters do not fit its states, or that names objects which its cell does not have.

    Args:
        behavior: The behavior.
        catalogue: The states by name.
        cell: The open cell.
        parameters: The parameters of the run.

    Raises:
        DocumentError: a value does not fit, or a robot, part, frame or other object is not in the cell; `where` is the
            position.
    """
    require_no_errors(check_given(behavior, catalogue, cell, parameters))

"""Creates runs: new ones, ones that start from an event of another run, and resumed ones.

Whatever can be refused is refused before the journal knows of the run.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

import msgspec

from engine.cell.cell_store import absolute_address
from engine.cell.open_cell import OpenCell
from engine.check import check_given, require_no_errors
from engine.document import Behavior
from engine.document.cell import Cell
from engine.errors import ControlError
from engine.journal import JournalPort, NullJournal, RunOrigin
from engine.recording.recorded_run import RecordedRun, document_snapshot, read_run
from engine.runtime.control import LEVELS, AutonomyLevel
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.hot_change import plan_change
from engine.runtime.history.resume import last_entered_state, read_history, resume_checkpoint, start_checkpoint
from engine.runtime.history.run_reducer import RunStateReducer
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.runtime.record.skill_port import SkillPort
from engine.runtime.run import Run
from engine.runtime.run_id import new_run_id
from engine.runtime.run_options import RunOptions


def new_origin(
    behavior: Behavior, *, cell: OpenCell, supervision: RunOptions | None = None, source: str | None = None
) -> RunOrigin:
    """Return what a journal keeps of how a run is started.

    Args:
        behavior: What is executed.
        cell: The open cell.
        supervision: How it is watched over.
        source: How the behavior is named where its file alone does not say it: `FILE.py:NAME`.
    """
    watched = supervision or RunOptions()
    document, documents = document_snapshot(behavior)
    return RunOrigin(
        behavior=source or str(behavior.file.resolve()),
        document=document,
        documents=documents,
        cell=str(cell.document.file.resolve()) if cell.document is not None else None,
        store=absolute_address(cell.store_path) if cell.store_path is not None else None,
        seed=cell.seed,
        clock="virtual" if cell.bus.clock.virtual else "real",
        autonomy=watched.autonomy,
        demand_operator=watched.demand_operator,
    )


def new_run(
    plan: Plan,
    *,
    cell: OpenCell,
    journal: JournalPort,
    parameters: Mapping[str, object] | None = None,
    inputs: Mapping[str, object] | None = None,
    seed: int = 0,
    origin: RunOrigin | None = None,
    supervision: RunOptions | None = None,
    skills: SkillPort | None = None,
    checkpoint: Checkpoint | None = None,
) -> Run:
    """Enter a new run into the journal and return it, not yet executing.

    Args:
        plan: What is executed.
        cell: Where.
        journal: Where its events are kept.
        parameters: Values for the behavior's parameters.
        inputs: Initial values of userdata keys.
        seed: Of its random numbers.
        origin: How it is started, for whoever resumes it; without it it cannot be resumed.
        supervision: Operator, autonomy, breakpoints, time-outs.
        skills: Stands in for the bus.
        checkpoint: The moment of another run to begin at.

    Raises:
        DocumentError: a parameter or input is not acceptable; the journal knows nothing of it.
        JournalError: the journal cannot be written.
        RobotError: it commands devices, and one of the cell is lost.
    """
    _require_devices(plan, cell)
    checked = plan.checked_parameters(parameters or {})
    given = plan.checked_inputs(inputs or {})
    run_id = new_run_id(plan.name)
    if origin is not None:
        origin = msgspec.structs.replace(
            origin,
            parameters=msgspec.to_builtins(checked),
            inputs=msgspec.to_builtins(given),
            run_seed=seed,
        )
    entry = journal.begin(
        run_id, behavior=plan.name, document=plan.document_hash, started_unix_s=time.time(), origin=origin
    )
    return Run(
        plan,
        run=run_id,
        bus=cell.bus,
        parameters=checked,
        inputs=given,
        seed=seed,
        journal=entry,
        supervision=supervision,
        skills=skills,
        checkpoint=checkpoint,
        world=cell.snapshot if cell.has_world and not isinstance(journal, NullJournal) else None,
    )


def _require_devices(plan: Plan, cell: OpenCell) -> None:
    """Refuse what commands devices while one is lost: its first motion would only fail."""
    if plan.commands_hardware:
        cell.require_connected()


def require_simulation(plan: Plan, cell: Cell | None, *, allowed: bool = False) -> None:
    """Refuse to let others stand in for nodes where a robot of the cell is real, unless that is said.

    Raises:
        ControlError: a robot is real.
    """
    robots = cell.document.robots if cell is not None else {}
    real = [name for name, entry in robots.items() if not entry.simulated]
    if plan.stood_in_for and real and not allowed:
        raise ControlError(
            f"something stands in for {plan.stood_in_for[0]}, and {real[0]} is a real robot",
            where=plan.name,
            hint="run it in a simulated cell; `--substitute-on-robots` runs it here",
        )


def require_names(behavior: Behavior, catalogue: Catalogue, cell: Cell, parameters: Mapping[str, object]) -> None:
    """Refuse a run that names what its cell does not have.

    Args:
        behavior: What is to run.
        catalogue: The states by name.
        cell: Where.
        parameters: What the run is given.

    Raises:
        DocumentError: a robot, part, frame or another thing is not in the cell; `where` is the position.
    """
    require_no_errors(check_given(behavior, catalogue, cell, parameters))


@dataclass(frozen=True, kw_only=True)
class RunPosition:
    """An event of a run in the journal; `path` is the node to begin at, by default the state entered last."""

    run: str
    seq: int
    path: str | None = None


def checkpoint_at(found: RecordedRun, plan: Plan, *, seq: int, path: str | None = None) -> Checkpoint:
    """Return a moment of a run as the start of a new one.

    Args:
        found: The run.
        plan: What the new run executes; it may be another version.
        seq: The event whose data it has.
        path: The node it begins at; by default the state that was entered last.

    Raises:
        DocumentError: the run has no such event, or had entered no state by then.
        ControlError: it cannot begin at this node.
    """
    found.require_event(seq)
    history = read_history(plan, found.id, found.events, until_seq=seq)
    return start_checkpoint(history, plan, path or last_entered_state(found.effective, seq))


@dataclass(frozen=True, kw_only=True)
class ResumePlan:
    """How an interrupted run is to go on."""

    found: RecordedRun
    plan: Plan
    checkpoint: Checkpoint | None
    """None when nothing of it had become durable: it begins anew."""
    restores: bool
    """Whether the simulated world is brought to where it was."""
    autonomy: AutonomyLevel = "full"
    """What it had last."""
    changes: tuple[str, ...] = ()
    """What is different in a behavior that has changed since, a line for each."""


def plan_resume(
    found: RecordedRun,
    plan: Plan,
    *,
    catalogue: Catalogue,
    answers: Mapping[str, str] | None = None,
    demanded: bool = False,
    changed: bool = False,
    restore: bool = True,
    take_over: bool = False,
) -> ResumePlan:
    """Decide how an interrupted run goes on; touches nothing.

    Args:
        found: The run.
        plan: Its behavior.
        catalogue: The states, for the version of the behavior that the journal holds.
        answers: rerun, or an outcome, for states that were in mid-work.
        demanded: Whether an operator is demanded from now on, if it was not before.
        changed: Whether the behavior may be another version than that which was executed.
        restore: Whether the simulated world can be brought to where it was. What was done in it after
            its last snapshot is then done anew, as in the world it never was.
        take_over: Whether to go on although an engine seems to drive it.

    Raises:
        NeedsAnswers: states in mid-work ask.
        ControlError: it is over, is driven by an engine, or cannot go on in this version.
        DocumentError: this version does not have a node that is active.
    """
    record = found.record
    if record.status != "running":
        raise ControlError(f"this run is over ({record.status})", where=found.id, hint="start a new one")
    if record.driver is not None and not take_over:
        hint = "stop that process first; `--take-over` leaves it unable to go on"
        raise ControlError(f"process {record.driver} drives this run", where=found.id, hint=hint)
    if plan.document_hash != found.document and not changed:
        hint = "`--changed` goes on in the new version where that is possible"
        raise ControlError(f"the behavior {plan.name} has changed since", where=found.origin.behavior, hint=hint)
    restores = restore and found.world is not None
    begun_with = _autonomy(found)
    if not found.events:
        return ResumePlan(found=found, plan=plan, checkpoint=None, restores=False, autonomy=begun_with)
    until_seq = found.world.seq if restores and found.world is not None else None
    changes: tuple[str, ...] = ()
    if plan.document_hash != found.document:
        changes = _changes(found, plan, catalogue, until_seq)
    history = read_history(plan, found.id, found.events, until_seq=until_seq)
    checkpoint = resume_checkpoint(
        history,
        plan,
        answers=answers or {},
        demanded=demanded or found.origin.demand_operator,
        last_seq=found.events[-1].seq,
    )
    known = {name: value for name, value in checkpoint.parameters.items() if name in plan.parameters}
    checkpoint = replace(checkpoint, parameters=plan.checked_parameters(known))
    return ResumePlan(
        found=found,
        plan=plan,
        checkpoint=checkpoint,
        restores=restores,
        autonomy=history.autonomy or begun_with,
        changes=changes,
    )


def _autonomy(found: RecordedRun) -> AutonomyLevel:
    for level in LEVELS:
        if level == found.origin.autonomy:
            return level
    return "full"


def _changes(found: RecordedRun, plan: Plan, catalogue: Catalogue, until_seq: int | None) -> tuple[str, ...]:
    """Return what has changed; refused by the same rules as a change of a paused run."""
    recorded = found.behavior_now()
    if recorded is None or recorded.meaning != found.document:
        # It was changed while it ran: that version is not kept, so only what is active can be compared.
        read_history(plan, found.id, found.events, until_seq=until_seq).checkpoint()
        return ("the version that it was executing is not in the journal: only its active nodes were compared",)
    old = new_plan(recorded, catalogue)
    history = read_history(old, found.id, found.events, until_seq=until_seq)
    report = plan_change(
        old,
        plan,
        active={path: old.nodes[path] for path in history.active},
        waiting=_waiting(history),
        still=True,
    )
    gone = [f"{path} is not in the new version, and its container is active" for path in report.removed]
    if report.refusals or gone:
        refusals = "; ".join((*report.refusals, *gone))
        raise ControlError(refusals, where=found.id, hint="resume it with the old version")
    return report.changes


def _waiting(history: RunStateReducer) -> Mapping[str, str]:
    points = history.checkpoint().points
    return {path: point.left for path, point in points.items() if point.left is not None}


async def resume_run(
    resumption: ResumePlan,
    *,
    cell: OpenCell,
    journal: JournalPort,
    catalogue: Catalogue,
    answers: Mapping[str, str] | None = None,
    supervision: RunOptions | None = None,
    skills: SkillPort | None = None,
) -> Run:
    """Take an interrupted run over and return it, not yet executing; the engine before can write no more.

    Args:
        resumption: What `plan_resume` has decided.
        cell: The cell it was in, opened with the seed of its origin, before anything moves.
        journal: The journal it is in.
        catalogue: As for `plan_resume`.
        answers: As for `plan_resume`.
        supervision: Operator, autonomy, breakpoints, time-outs.
        skills: Stands in for the bus.

    Raises:
        JournalError: the journal cannot be written.
        RobotError: a device of the cell is lost, or the world cannot be brought to where it was.
        ControlError: its engine has gone on meanwhile, to where it cannot be resumed like this.
    """
    plan, found = resumption.plan, resumption.found
    _require_devices(plan, cell)
    entry = journal.resume(found.id)
    now = read_run(found.place, found.id)
    if now.record.last_seq != found.record.last_seq:
        # Whoever drove it was alive until just now; what it has done since counts.
        resumption = plan_resume(
            now,
            plan,
            catalogue=catalogue,
            answers=answers,
            demanded=supervision is not None and supervision.demand_operator,
            changed=True,
            restore=resumption.restores,
            take_over=True,
        )
    checkpoint = resumption.checkpoint
    if resumption.restores and now.world is not None:
        await cell.restore(now.world.data)
    origin = now.origin
    return Run(
        plan,
        run=now.id,
        bus=cell.bus,
        parameters=checkpoint.parameters if checkpoint is not None else origin.parameters,
        inputs=origin.inputs if checkpoint is None else {},
        seed=origin.run_seed,
        journal=entry,
        supervision=supervision,
        skills=skills,
        checkpoint=replace(checkpoint, epoch=entry.epoch) if checkpoint is not None else None,
        world=cell.snapshot if cell.has_world else None,
    )

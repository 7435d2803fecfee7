"""Creates runs: new ones, ones that start from an event of another run, and resumed ones.

All checks are done before the run is entered into the journal.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated

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
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.resume import last_entered_state, read_history, resume_checkpoint, start_checkpoint
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.runtime.record.skill_port import SkillPort
from engine.runtime.run import Run
from engine.runtime.run_id import new_run_id
from engine.runtime.run_options import RunOptions


def new_origin(
    behavior: Behavior, *, cell: OpenCell, supervision: RunOptions | None = None, source: str | None = None
) -> RunOrigin:
    """Return the origin of a run: what a journal keeps about its start.

    Args:
        behavior: The behavior that is executed.
        cell: The open cell.
        supervision: Options of the run: operator, autonomy, breakpoints.
        source: Name of the behavior, if its file alone does not identify it: `FILE.py:NAME`.
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
        plan: The plan that is executed.
        cell: The open cell.
        journal: The journal of its events.
        parameters: Values for the behavior's parameters.
        inputs: Initial values of userdata keys.
        seed: Seed of its random numbers.
        origin: How it is started; a run without it cannot be resumed.
        supervision: Operator, autonomy, breakpoints, time-outs.
        skills: Replaces the bus.
        checkpoint: The state of another run to start from.

    Raises:
        DocumentError: a parameter or input is invalid; the journal has no entry of the run.
        JournalError: the journal cannot be written.
        RobotError: the run commands devices, and a device of the cell is lost.
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
    """Reject a run that commands devices while one is lost: its first motion would fail."""
    if plan.commands_hardware:
        cell.require_connected()


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


class RunPosition(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An event of a run in the journal; `path` is the node to start at, by default the state entered last."""

    run: str
    seq: Annotated[int, msgspec.Meta(ge=1)]
    path: str | None = None


def checkpoint_at(found: RecordedRun, plan: Plan, *, seq: int, path: str | None = None) -> Checkpoint:
    """Return the checkpoint at an event of a run, to start a new run from.

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
    return start_checkpoint(history, plan, path or last_entered_state(found.effective, seq))


@dataclass(frozen=True, kw_only=True)
class ResumePlan:
    """How an interrupted run is resumed."""

    found: RecordedRun
    plan: Plan
    checkpoint: Checkpoint | None
    """None if no event of the run is durable: it starts from the beginning."""
    restores: bool
    """Whether the simulated world is restored."""
    autonomy: AutonomyLevel = "full"
    """The last autonomy level of the run."""
    changes: tuple[str, ...] = ()
    """Changes of the behavior since the run, one line each."""


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
    """Decide how an interrupted run is resumed; changes nothing.

    Args:
        found: The run.
        plan: Its behavior.
        catalogue: The states, for the version of the behavior that the journal holds.
        answers: `rerun`, or an outcome, for states that were active.
        demanded: Whether an operator is demanded from now on, if it was not before.
        changed: Whether the behavior may be another version than the executed one.
        restore: Whether the simulated world can be restored. Actions after its last snapshot are
            then executed again, because the restored world does not contain them.
        take_over: Whether to resume although another process seems to execute the run.

    Raises:
        ResumeDecisionRequired: states that were active require a decision.
        ControlError: the run has ended, another process executes it, or it cannot be resumed in this version.
        DocumentError: this version does not have a node that is active.
    """
    record = found.record
    if record.status != "running":
        raise ControlError(f"this run is over ({record.status})", where=found.id, hint="start a new one")
    if record.driver is not None and not take_over:
        hint = "stop that process first, or use `--take-over`, which stops its run"
        raise ControlError(f"process {record.driver} executes this run", where=found.id, hint=hint)
    if plan.document_hash != found.document and not changed:
        hint = "`--changed` resumes in the new version if the change permits it"
        raise ControlError(
            f"the behavior {plan.name} has changed since the run", where=found.origin.behavior, hint=hint
        )
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
        autonomy=history.state.autonomy or begun_with,
        changes=changes,
    )


def _autonomy(found: RecordedRun) -> AutonomyLevel:
    for level in LEVELS:
        if level == found.origin.autonomy:
            return level
    return "full"


def _changes(found: RecordedRun, plan: Plan, catalogue: Catalogue, until_seq: int | None) -> tuple[str, ...]:
    """Return the changes; rejected by the same rules as a hot change of a paused run."""
    recorded = found.behavior_now()
    if recorded is None or recorded.meaning != found.document:
        # The behavior was changed during the run: that version is not kept, so only active nodes can be compared.
        read_history(plan, found.id, found.events, until_seq=until_seq).checkpoint()
        return ("the executed version is not in the journal: only its active nodes were compared",)
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


def _waiting(history: ResumableState) -> Mapping[str, str]:
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
    """Take over an interrupted run and return it, not yet executing; the previous process can no longer write.

    Args:
        resumption: The decision of `plan_resume`.
        cell: The cell of the run, opened with the seed of its origin, before any motion.
        journal: The journal of the run.
        catalogue: As for `plan_resume`.
        answers: As for `plan_resume`.
        supervision: Operator, autonomy, breakpoints, time-outs.
        skills: Replaces the bus.

    Raises:
        JournalError: the journal cannot be written.
        RobotError: a device of the cell is lost, or the world cannot be restored.
        ControlError: its previous process has continued the run, which can no longer be resumed like this.
    """
    plan, found = resumption.plan, resumption.found
    _require_devices(plan, cell)
    entry = journal.resume(found.id)
    now = read_run(found.place, found.id)
    if now.record.last_seq != found.record.last_seq:
        # The previous process was alive until now; events that it wrote since count.
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

"""How an interrupted run is resumed: decided from its events and the current version of its behavior."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from engine.errors import ControlError
from engine.recording.recorded_run import RecordedRun
from engine.runtime.control import LEVELS, AutonomyLevel
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.hot_change import plan_change
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.resume import read_history, resume_checkpoint
from engine.runtime.plan import Catalogue, Plan, new_plan


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
    catalogue: Catalogue
    """The states, for another decision when the run has continued since this one."""
    answers: Mapping[str, str] = field(default_factory=dict[str, str])
    """What was decided for states that were active."""


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
    given = answers or {}
    if not found.events:
        return ResumePlan(
            found=found,
            plan=plan,
            checkpoint=None,
            restores=False,
            autonomy=begun_with,
            catalogue=catalogue,
            answers=given,
        )
    until_seq = found.world.seq if restores and found.world is not None else None
    changes: tuple[str, ...] = ()
    if plan.document_hash != found.document:
        changes = _changes(found, plan, catalogue, until_seq)
    history = read_history(plan, found.id, found.events, until_seq=until_seq)
    checkpoint = resume_checkpoint(
        history,
        plan,
        answers=given,
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
        catalogue=catalogue,
        answers=given,
    )


def plan_again(resumption: ResumePlan, now: RecordedRun, *, demanded: bool) -> ResumePlan:
    """Decide again when the previous process was alive until now: events that it wrote since count.

    Args:
        resumption: The earlier decision.
        now: The run after it was taken over.
        demanded: Whether an operator is demanded from now on.

    Raises:
        ControlError: the run can no longer be resumed like this.
    """
    if now.record.last_seq == resumption.found.record.last_seq:
        return replace(resumption, found=now)
    return plan_resume(
        now,
        resumption.plan,
        catalogue=resumption.catalogue,
        answers=resumption.answers,
        demanded=demanded,
        changed=True,
        restore=resumption.restores,
        take_over=True,
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

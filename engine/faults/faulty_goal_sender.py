"""Faults of action goals: which goals are sent, how often, and which handle the state receives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from engine.bus import GoalStatus, Holder
from engine.errors import Cause, FlexcellError, SkillFailed
from engine.faults import goal_faults as plays
from engine.faults.fault_context import FaultContext
from engine.faults.fault_rule import FaultRule
from engine.faults.faulty_goal import FaultyGoal, GoalScript
from engine.runtime.record.skill_port import Goal, SkillPort
from engine.skill import Action
from engine.skills.device_moves import SimulateDeviceFault


@dataclass(frozen=True)
class RepeatableGoal:
    """A goal with its address and state; each call sends it."""

    inner: SkillPort
    goal: Action[Any, Any]
    to: str
    holder: Holder
    goal_id: str

    @property
    def address(self) -> str:
        """`<namespace>/<skill_name>`."""
        return self.goal.address(self.to)

    def __call__(self) -> Goal:
        """Send it; raises what the bus raises."""
        return self.inner.send_goal(self.goal, to=self.to, holder=self.holder, goal_id=self.goal_id)


def send_faulty_goal(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    """Apply a fault to a goal and return the handle for the state; raises the errors of the bus."""
    match rule.fault.kind:
        case "late":
            return _late(rule, sending, scene)
        case "hang":
            return _hang(rule, sending, scene)
        case "error":
            return _fail(rule, sending, scene)
        case "duplicate":
            return _twice(rule, sending, scene)
        case "lost":
            return _lose(rule, sending, scene)
        case "crash":
            return _crash(rule, sending, scene)
        case "device":
            return _break_device(rule, sending, scene)


def _late(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    sent = sending()
    delay_s = rule.fault.late_s
    _apply(rule, sending, scene, f"its end is reported {delay_s:g} s late")
    return _playing(plays.delay_end(sent, delay_s, scene.clock), sending, sent)


def _hang(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    sent = sending()
    if rule.ignores_cancel:
        _apply(rule, sending, scene, "its end is never reported and it ignores cancel requests")
        return _playing(plays.ignore_all(), sending, sent, ignores_cancel=True)
    _apply(rule, sending, scene, "its end is never reported")
    return _playing(plays.withhold_end(sent), sending, sent)


def _fail(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    failure = rule.failure
    cause = Cause(message=failure.message, where=sending.address, kind="SkillFailed")
    aborts_later = failure.by == "abort" and failure.after_s > 0
    sent = sending() if aborts_later else None
    _apply(rule, sending, scene, f"fails: {failure.message}")
    if sent is not None:
        return _playing(plays.abort_after(sent, failure.after_s, cause), sending, sent)
    if failure.by == "raise":
        raise SkillFailed(failure.message, where=sending.address)
    status = GoalStatus.REJECTED if failure.by == "reject" else GoalStatus.ABORTED
    return _playing(plays.fail_goal(status, cause, failure.after_s, scene.clock), sending)


def _twice(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    sent = sending()

    def copy() -> Goal | None:
        try:
            return sending()
        except FlexcellError as error:
            # The state does not know of the copy; this line records the response of the bus.
            scene.note(rule, sending.holder.branch, sending.address, f"the copy of the goal was rejected: {error}")
            return None

    if rule.fault.duplicate == "after_end":
        _apply(rule, sending, scene, "sent again after its end")
        return _playing(plays.copy_after_end(sent, copy), sending, sent)
    _apply(rule, sending, scene, "sent twice at once")
    second = copy()
    if second is None:
        return _playing(plays.pass_through(sent), sending, sent)
    return _playing(plays.copy_at_once(sent, second), sending, sent, second)


def _lose(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    if rule.fault.lost == "request":
        _apply(rule, sending, scene, "the goal is lost")
        return _playing(plays.lose_request(), sending)
    sent = sending()
    _apply(rule, sending, scene, "its end is lost")
    return _playing(plays.lose_answer(sent), sending, sent)


def _crash(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    if rule.fault.crash is not None and rule.fault.crash.on_request == "before":
        _apply(rule, sending, scene, "killed before it is sent")
        scene.kill()
        sent = sending()
        return _playing(plays.pass_through(sent), sending, sent)
    sent = sending()
    _apply(rule, sending, scene, "killed once it has ended")
    return _playing(plays.kill_after(sent, scene.kill), sending, sent)


def _break_device(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext) -> FaultyGoal:
    broken = rule.fault.device
    assert broken is not None
    request = SimulateDeviceFault(fault=broken)
    words = {
        "no air": not broken.air,
        f"{broken.stuck} is stuck": bool(broken.stuck),
        f"{broken.sensor} says {'on' if broken.reads else 'off'}": bool(broken.sensor),
    }
    _apply(rule, sending, scene, f"breaks the device: {', '.join(word for word, on in words.items() if on)}")

    async def break_it() -> None:
        answer = await sending.inner.call(request, to=sending.to, holder=sending.holder)
        if not answer.success:
            raise SkillFailed(answer.message, where=sending.address)

    return _playing(plays.send_after(break_it, sending), sending)


def _apply(rule: FaultRule, sending: RepeatableGoal, scene: FaultContext, detail: str) -> None:
    scene.apply(rule, sending.holder.branch, sending.address, detail)


def _playing(play: GoalScript, sending: RepeatableGoal, *sent: Goal, ignores_cancel: bool = False) -> FaultyGoal:
    return FaultyGoal(play, sent=sent, name=f"fault of {sending.goal_id}", ignores_cancel=ignores_cancel)

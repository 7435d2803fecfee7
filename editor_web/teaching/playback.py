"""Slow playback of a taught motion: to its start, then along it."""

from __future__ import annotations

from typing import Any, cast

import msgspec

from editor_web.teaching.goal_failure_text import goal_failure_text
from editor_web.teaching.taught_entries import TaughtData, read_taught, trace
from editor_web.teaching.teaching_messages import PlaybackResult, PlayBody
from engine.bus import GoalStatus, JsonBus
from engine.errors import FlexcellError
from engine.skills.dmp import LearnedCartDmp, LearnedJointDmp

# Fraction of the joint limits: half of it is fast, a tenth is slow.
_JOINT_SHARE = 0.4
Goal = tuple[str, dict[str, object]]


async def play(bus: JsonBus, request: PlayBody) -> PlaybackResult:
    """Play back a motion and return its end; on cancellation, the arm comes to rest first.

    Raises:
        FlexcellError: there is no such entry or capture, or it belongs to another arm.
    """
    taught = await _as_motion(bus, request.arm, await read_taught(bus, request))
    for skill, goal in await _goals(bus, request, taught):
        end = await bus.perform(f"{request.arm}/{skill}", goal)
        if end.status is not GoalStatus.SUCCEEDED:
            return PlaybackResult(status=end.status.value, cause=goal_failure_text(end))
    return PlaybackResult(status=GoalStatus.SUCCEEDED.value, cause="")


async def _as_motion(bus: JsonBus, arm: str, taught: TaughtData) -> TaughtData:
    """Return the primitive learned from a recording: recordings themselves cannot be executed."""
    if taught.kind != "trajectory":
        return taught
    learn = "learn_joint_dmp" if taught.value.get("joints") else "learn_cart_dmp"
    answer = await bus.call(f"{arm}/{learn}", {"trajectory": taught.value})
    if learn == "learn_joint_dmp":
        joint = msgspec.json.decode(answer, type=LearnedJointDmp).dmp
        return TaughtData(kind="dmp", value=msgspec.to_builtins(joint))
    return TaughtData(kind="cart_dmp", value=msgspec.to_builtins(msgspec.json.decode(answer, type=LearnedCartDmp).dmp))


async def _goals(bus: JsonBus, request: PlayBody, taught: TaughtData) -> list[Goal]:
    speed = _JOINT_SHARE * request.speed
    match taught.kind:
        case "joints":
            return [("joint_trap_vel", {"joints": taught.value["joints"], "speed": speed})]
        case "pose":
            return [("cart_trap_vel", {"pose": taught.value, "speed": speed})]
        case "dmp":
            start = (await trace(bus, request.arm, taught)).joints[0]
            approach: Goal = ("joint_trap_vel", {"joints": start, "speed": speed})
            return [approach, ("joint_dmp", {"dmp": _slower(taught.value, request.speed)})]
        case "cart_dmp":
            motion = await trace(bus, request.arm, taught)
            pose = motion.poses[0]
            to_start: Goal = ("cart_trap_vel", {"pose": {"xyz": pose[:3], "xyzw": pose[3:]}, "speed": speed})
            return [to_start, ("cart_dmp", {"dmp": _slower(taught.value, request.speed)})]
        case _:
            raise FlexcellError(f"an entry of kind {taught.kind} cannot be played back", where=request.arm)


def _slower(dmp: dict[str, object], share: float) -> dict[str, object]:
    """Return the same path with a longer duration."""
    values = cast("dict[str, Any]", dmp)
    return {**values, "tau": values["tau"] / share, "dy0": [rate * share for rate in values["dy0"]]}

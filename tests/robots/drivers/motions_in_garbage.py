"""Motions of an arm while garbage passes between its driver and its emulated controller, judged by its true joints."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from engine.errors import RobotError
from robots.model.robot_model import JointLimits
from robots.port import Array, MotionEnd
from tests.robots.drivers.faulty_process_arm import WIDE, SupervisedArm
from tests.robots.sim.sim_cell import smooth, until

_RECOVERY_S = 120.0
_RESTING_RAD_S = 0.05
_REST_LIMIT_S = 5.0
_PATH_S = 1.0
_ATTEMPTS = 5


@dataclass(frozen=True, kw_only=True)
class TrueState:
    """What is true of the arm: `ended_s` is when the last set point reached its controller, all by its own clock."""

    time_s: float
    joints_rad: Array
    ended_s: float


@dataclass(kw_only=True)
class GarbageOutcome:
    """What happened. `rest_s` is from the last set point to rest, of motions that failed; `off_rad` and
    `fastest_share` are the most that the true joints were off their paths, and moved as a share of their limits."""

    garbage: int = 0
    ends: Counter[str] = field(default_factory=Counter[str])
    refusals: Counter[str] = field(default_factory=Counter[str])
    unnamed: int = 0
    rest_s: list[float] = field(default_factory=list[float])
    off_rad: float = 0.0
    fastest_share: float = 0.0


@dataclass(frozen=True, kw_only=True)
class MovedArm:
    """An arm between two configurations; `state` reads the true state, `spoil` sets the share of garbage."""

    connection: SupervisedArm
    limits: JointLimits
    start: Array
    goal: Array
    state: Callable[[], TrueState]
    spoil: Callable[[float], None]
    garbage: Callable[[], int]


async def move_in_garbage(arm: MovedArm, motions: int, *, share: float) -> GarbageOutcome:
    """Move to and fro; what ends a motion is noted, and a person enables the arm again, in the garbage at first."""
    outcome = GarbageOutcome()
    for number in range(motions):
        await _enable(arm, outcome, share=share)
        await _move(arm, outcome, arm.goal if number % 2 == 0 else arm.start, share=share)
    outcome.garbage = arm.garbage()
    return outcome


async def _enable(arm: MovedArm, outcome: GarbageOutcome, *, share: float) -> None:
    connection = arm.connection
    arm.spoil(0.0)
    await until(lambda: not connection.lost_reason, within_s=_RECOVERY_S)
    before = await asyncio.to_thread(arm.state)
    arm.spoil(share)
    try:
        await connection.enable()
    except RobotError as error:
        outcome.refusals[_named(error.message)] += 1
        arm.spoil(0.0)
        await _enable_after_garbage(connection)
    after = await asyncio.to_thread(arm.state)
    outcome.off_rad = max(outcome.off_rad, float(np.abs(after.joints_rad - before.joints_rad).max()))


async def _enable_after_garbage(connection: SupervisedArm) -> None:
    """What came in the garbage may count for a while, and lose the connection once more."""
    attempts = _ATTEMPTS
    while attempts:
        attempts -= 1
        await until(lambda: not connection.lost_reason, within_s=_RECOVERY_S)
        try:
            await connection.report(readings=20)
            await connection.enable()
        except RobotError:
            if not attempts:
                raise
        else:
            return


async def _move(arm: MovedArm, outcome: GarbageOutcome, goal: Array, *, share: float) -> None:
    connection = arm.connection
    arm.spoil(share)
    # From where the arm is, whatever a measurement says.
    first = await asyncio.to_thread(arm.state)
    try:
        start = np.asarray(connection.port.sample().desired_rad)
        motion = connection.port.follow(smooth(start, goal, _PATH_S, limits=arm.limits), tolerance=WIDE)
    except RobotError as error:
        outcome.refusals[_named(error.message)] += 1
        return
    reporting = asyncio.ensure_future(motion.report())
    states = [first]
    while not reporting.done():
        states.append(await asyncio.to_thread(arm.state))
    report = await reporting
    arm.spoil(0.0)
    limit_s = states[-1].time_s + _REST_LIMIT_S
    while report.end is not MotionEnd.REACHED and not _is_at_rest(states) and states[-1].time_s < limit_s:
        states.append(await asyncio.to_thread(arm.state))
    _judge(arm, outcome, states, goal=goal, has_failed=report.end is not MotionEnd.REACHED)
    if report.end is MotionEnd.REACHED:
        outcome.ends["reached"] += 1
    else:
        outcome.ends[_named(report.reason)] += 1
        outcome.unnamed += not report.reason


def _judge(arm: MovedArm, outcome: GarbageOutcome, states: list[TrueState], *, goal: Array, has_failed: bool) -> None:
    first = states[0].joints_rad
    lower, upper = np.minimum(first, goal), np.maximum(first, goal)
    for state in states:
        off = np.maximum(lower - state.joints_rad, state.joints_rad - upper).max()
        outcome.off_rad = max(outcome.off_rad, float(off))
    moving_s = states[0].time_s
    for before, after in pairwise(states):
        if after.time_s > before.time_s:
            speed = np.abs(after.joints_rad - before.joints_rad) / (after.time_s - before.time_s)
            outcome.fastest_share = max(
                outcome.fastest_share, float((speed / np.array(arm.limits.velocity_rad_s)).max())
            )
            if speed.max() > _RESTING_RAD_S:
                moving_s = after.time_s
    if has_failed:
        outcome.rest_s.append(max(0.0, moving_s - states[-1].ended_s))


def _is_at_rest(states: list[TrueState]) -> bool:
    """Whether the true joints have rested for the last 0.2 s."""
    last = states[-1]
    recent = [each for each in states if each.time_s > last.time_s - 0.2]
    if len(recent) < 3 or recent[0].time_s > last.time_s - 0.1:
        return False
    return all(np.abs(each.joints_rad - last.joints_rad).max() < _RESTING_RAD_S * 0.2 for each in recent)


def _named(reason: str) -> str:
    """Return the cause without its numbers."""
    words = reason.split(": ")
    cause = ": ".join(words[1:3]) if words[0].startswith("arm at ") else ": ".join(words[:2])
    return " ".join(word for word in cause.split() if not any(each.isdigit() for each in word))[:60]

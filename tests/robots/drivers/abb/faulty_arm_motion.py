"""A fault in the middle of an arm's motion: how it shows, what moves meanwhile, and what it takes to move again."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from engine.bus import GoalStatus
from engine.errors import FlexcellError, RobotError
from engine.skills.motion import JointTrapVel
from tests.robots.drivers.abb.emulated_irc5 import ARM, HOME, EmulatedIrc5, served
from tests.robots.drivers.fault_cases import FaultCase, refusal_of

TARGET_RAD = 0.6
_LIMIT_S = 30.0
_SPEED = 0.06


@dataclass(frozen=True, kw_only=True)
class ArmFaultOutcome:
    """What happened.

    `rest_rad` is where the first axis came to rest; `stop_requests` arrived because of the fault. Between rest and the
    person's command, `moved_rad` is how far the axes went and `started` how many trajectories began, and `refused`
    are the causes of the goals.
    """

    status: GoalStatus
    cause: str
    noticed_s: float
    rest_s: float | None
    lost_reason: str
    rest_rad: float
    stop_requests: int
    started: int
    moved_rad: float
    refused: tuple[str, ...]
    moves_again: bool


def goal(angle_rad: float, *, speed: float = _SPEED) -> JointTrapVel:
    """Return a motion of the first axis."""
    return JointTrapVel(joints=(angle_rad, *HOME[1:]), speed=speed)


async def faulty_arm_motion(emulator: EmulatedIrc5, case: FaultCase) -> ArmFaultOutcome:
    """Move, cause the fault, end it, look whether anything moves, and recover as a person would."""
    async with served(emulator) as (bus, connection):
        await bus.send_goal(goal(0.0, speed=0.5), to=ARM).result()
        handle = bus.send_goal(goal(TARGET_RAD), to=ARM)
        while connection.port.sample().position_rad[0] < 0.05:
            await bus.clock.sleep(0.01)
        stops_before = len(emulator.do("state")["stop_requests"])
        begun_s = time.monotonic()
        emulator.do(case.do, **case.values)
        if case.do == "refuse":
            await handle.hold()
        end = await handle.result()
        noticed_s = time.monotonic() - begun_s
        while emulator.do("state")["in_motion"] and time.monotonic() - begun_s < _LIMIT_S:
            await bus.clock.sleep(0.05)
        rest_s = None if emulator.do("state")["in_motion"] else time.monotonic() - begun_s
        while case.lost and not connection.lost_reason and time.monotonic() - begun_s < _LIMIT_S:
            # The motion may fail a moment before, by its own port.
            await bus.clock.sleep(0.02)
        while not connection.problem and time.monotonic() - begun_s < _LIMIT_S:
            await bus.clock.sleep(0.02)
        lost_reason, rested = connection.lost_reason, emulator.do("state")
        refused = [await refusal_of(bus.send_goal(goal(0.0), to=ARM))]
        if case.do != "foreign":  # a program that was stopped is no cause any more
            refused.append(await _not_enabled(connection.enable()))
        emulator.do(case.restore[0], **case.restore[1])
        while connection.lost_reason and time.monotonic() - begun_s < _LIMIT_S:
            await bus.clock.sleep(0.02)
        await connection.report(readings=10)
        refused.append(await refusal_of(bus.send_goal(goal(0.0), to=ARM)))
        after = emulator.do("state")
        await connection.enable()
        last = await bus.send_goal(goal(0.1, speed=0.5), to=ARM).result()
        return ArmFaultOutcome(
            status=end.status,
            cause=end.cause.chain()[-1].message if end.cause is not None else "",
            noticed_s=noticed_s,
            rest_s=rest_s,
            lost_reason=lost_reason,
            rest_rad=rested["joints_rad"][0],
            stop_requests=len(rested["stop_requests"]) - stops_before,
            started=after["started"] - rested["started"],
            moved_rad=after["travel_rad"] - rested["travel_rad"],
            refused=tuple(refused),
            moves_again=last.status is GoalStatus.SUCCEEDED,
        )


async def _not_enabled(enabling: Any) -> str:
    """Return why motion was not permitted while the fault lasts; empty if it was."""
    try:
        await enabling
    except (FlexcellError, RobotError) as error:
        return str(error)
    return ""

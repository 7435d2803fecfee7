"""A fault in the middle of a gripper's motion: how it shows, and what it takes until the gripper moves again."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from engine.bus import GoalHandle, GoalStatus
from engine.errors import FlexcellError
from engine.skills.devices import EnableDevice
from engine.skills.gripper import GripperMove, GripperOpen
from tests.robots.drivers.emulated_gripper import HAND, EmulatedProcess, driven
from tests.robots.drivers.fault_cases import FaultCase

_LIMIT_S = 30.0


@dataclass(frozen=True, kw_only=True)
class FaultOutcome:
    """What happened.

    Between the fault and the person's command, `moved_after` is how far the fingers went, in counts, `commands_after`
    the number of commands that arrived, and `refused` are the causes of the goals.
    """

    status: GoalStatus
    cause: str
    noticed_s: float
    lost_reason: str
    commands_after: int
    moved_after: float
    refused: tuple[str, ...]
    moves_again: bool


async def faulty_motion(emulator: EmulatedProcess, case: FaultCase) -> FaultOutcome:
    """Move, cause the fault, end it, look whether anything moves, and recover as a person would."""
    emulator.do("object", width_m=None)
    async with driven(emulator, enable=True) as (bus, device):
        await bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
        goal = bus.send_goal(GripperMove(width_m=0.01, speed_m_s=0.05), to=HAND)
        while device.port.sample().width_m > 0.08:
            await bus.clock.sleep(0.01)
        begun_s = time.monotonic()
        emulator.do(case.do, **case.values)
        end = await goal.result()
        noticed_s = time.monotonic() - begun_s
        while emulator.do("state")["contact"] == "MOVING" and not emulator.do("state")["fault"]:
            await bus.clock.sleep(0.05)
            if case.do == "restart" or time.monotonic() - begun_s > _LIMIT_S:
                break
        while case.lost and not device.lost_reason and time.monotonic() - begun_s < _LIMIT_S:
            # The motion may fail a moment before, by a reading that is no longer fresh.
            await bus.clock.sleep(0.02)
        lost_reason = device.lost_reason
        if not case.lost:
            await device.report(readings=5)
        before = emulator.do("state")
        refused = [await _refusal(bus.send_goal(GripperOpen(), to=HAND))]
        emulator.do(case.restore[0], **case.restore[1])
        await device.report(readings=10)
        refused.append(await _refusal(bus.send_goal(GripperOpen(), to=HAND)))
        if device.lost_reason:
            try:
                await bus.call(EnableDevice(reason="before the connection is accepted"), to=HAND)
            except FlexcellError as error:
                refused.append(str(error))
            await device.reconnect()
            refused.append(await _refusal(bus.send_goal(GripperOpen(), to=HAND)))
        after = emulator.do("state")
        await bus.call(EnableDevice(reason="the cause is cleared"), to=HAND)
        last = await bus.send_goal(GripperMove(width_m=0.06, speed_m_s=0.15), to=HAND).result()
        return FaultOutcome(
            status=end.status,
            cause=end.cause.chain()[-1].message if end.cause is not None else "",
            noticed_s=noticed_s,
            lost_reason=lost_reason,
            commands_after=after["commands"] - before["commands"],
            moved_after=after["travel"] - before["travel"],
            refused=tuple(refused),
            moves_again=last.status is GoalStatus.SUCCEEDED,
        )


async def _refusal(handle: GoalHandle[Any, Any]) -> str:
    """Return why a goal failed; empty if it did not."""
    end = await handle.result()
    return end.cause.chain()[-1].message if end.cause is not None else ""

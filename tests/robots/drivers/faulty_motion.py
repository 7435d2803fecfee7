"""A fault in the middle of a tool's motion: how it shows, and what it takes until the tool moves again."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager, AbstractContextManager
from dataclasses import dataclass
from typing import Any

from engine.bus import GoalStatus, SkillBus
from engine.cell.drivers import Driver
from engine.errors import FlexcellError
from engine.skill import Action
from engine.skills.devices import EnableDevice
from robots.drivers.tool_device import ToolDevice
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.fault_cases import FaultCase, refusal_of

_LIMIT_S = 30.0


@dataclass(frozen=True, kw_only=True)
class FaultySubject:
    """A driver with its emulator, and motions during which faults happen.

    Attributes:
        driver: The driver.
        connections: All that it is tested over.
        cases: The faults.
        test: Path of the test that requires what the table says.
        device: Bus namespace of the tool.
        emulated: Starts an emulator on a connection.
        driven: Connects the driver and enables the tool.
        prepare: Removes objects.
        first: Goal of the motion before the one that a fault interrupts.
        moving: Goal of the motion that a fault interrupts.
        under_way: Whether that motion is in its middle, by the true state.
        at_rest: Whether the tool rests, by the true state.
        refused: Goal that is refused before a person has permitted motion.
        last: Goal of the motion at the end.
    """

    driver: Driver
    connections: tuple[str, ...]
    cases: tuple[FaultCase, ...]
    test: str
    device: str
    emulated: Callable[[str], AbstractContextManager[EmulatedProcess]]
    driven: Callable[[EmulatedProcess], AbstractAsyncContextManager[tuple[SkillBus, ToolDevice[Any, Any, Any]]]]
    prepare: Callable[[EmulatedProcess], object]
    first: Action[Any, Any]
    moving: Action[Any, Any]
    under_way: Callable[[dict[str, Any]], bool]
    at_rest: Callable[[dict[str, Any]], bool]
    refused: Action[Any, Any]
    last: Action[Any, Any]


@dataclass(frozen=True, kw_only=True)
class FaultOutcome:
    """What happened.

    Between the fault and the person's command, `moved_after` is how far the tool went, in its own counts,
    `commands_after` the number of commands that arrived, and `refused` are the causes of the goals.
    """

    status: GoalStatus
    cause: str
    noticed_s: float
    rest_s: float | None
    lost_reason: str
    commands_after: int
    moved_after: float
    refused: tuple[str, ...]
    moves_again: bool


async def faulty_motion(subject: FaultySubject, emulator: EmulatedProcess, case: FaultCase) -> FaultOutcome:
    """Move, cause the fault, end it, look whether anything moves, and recover as a person would."""
    subject.prepare(emulator)
    async with subject.driven(emulator) as (bus, device):
        to = subject.device
        await bus.send_goal(subject.first, to=to).result()
        goal = bus.send_goal(subject.moving, to=to)
        while not subject.under_way(emulator.do("state")):
            await bus.clock.sleep(0.01)
        begun_s = time.monotonic()
        emulator.do(case.do, **case.values)
        end = await goal.result()
        noticed_s = time.monotonic() - begun_s
        while not subject.at_rest(emulator.do("state")):
            await bus.clock.sleep(0.05)
            if case.do == "restart" or time.monotonic() - begun_s > _LIMIT_S:
                break
        rest_s = time.monotonic() - begun_s if subject.at_rest(emulator.do("state")) else None
        while case.lost and not device.lost_reason and time.monotonic() - begun_s < _LIMIT_S:
            # The motion may fail a moment before, by a reading that is no longer fresh.
            await bus.clock.sleep(0.02)
        lost_reason = device.lost_reason
        if not case.lost:
            await device.report(readings=5)
        before = emulator.do("state")
        refused = [await refusal_of(bus.send_goal(subject.refused, to=to))]
        emulator.do(case.restore[0], **case.restore[1])
        await device.report(readings=10)
        refused.append(await refusal_of(bus.send_goal(subject.refused, to=to)))
        if device.lost_reason:
            try:
                await bus.call(EnableDevice(reason="before the connection is accepted"), to=to)
            except FlexcellError as error:
                refused.append(str(error))
            await device.reconnect()
            refused.append(await refusal_of(bus.send_goal(subject.refused, to=to)))
        after = emulator.do("state")
        await bus.call(EnableDevice(reason="the cause is cleared"), to=to)
        last = await bus.send_goal(subject.last, to=to).result()
        return FaultOutcome(
            status=end.status,
            cause=end.cause.chain()[-1].message if end.cause is not None else "",
            noticed_s=noticed_s,
            rest_s=rest_s,
            lost_reason=lost_reason,
            commands_after=after["commands"] - before["commands"],
            moved_after=after["travel"] - before["travel"],
            refused=tuple(refused),
            moves_again=last.status is GoalStatus.SUCCEEDED,
        )

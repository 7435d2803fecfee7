"""A trace of a fault becomes a test: what a driver said of its tool, it says again of the capture."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Callable
from pathlib import Path

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.skills.gripper import GripperGrasp, GripperOpen
from engine.skills.hand import HandClose, HandOpen
from robots.drivers.robotiq.robotiq_gripper import RobotiqGripper
from robots.drivers.softhand.softhand import SoftHand
from tests.robots.drivers.emulated_device import EmulatedProcess, replayed
from tests.robots.drivers.emulated_gripper import CONNECTIONS, HAND, driven, emulated
from tests.robots.drivers.emulated_hand import HAND as SOFT_HAND
from tests.robots.drivers.emulated_hand import HAND_CONNECTIONS, driven_hand, emulated_hand

OVER_TEMPERATURE = 8
Inject = Callable[[], object]


def nothing() -> None:
    """What happened is in the capture already."""


async def grasp_until_fault(bus: SkillBus, device: RobotiqGripper, inject: Inject) -> tuple[GoalStatus, str]:
    """Open, then close; a fault comes in the middle."""
    await bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
    handle = bus.send_goal(GripperGrasp(width_m=0.02, force_n=60.0, speed_m_s=0.02), to=HAND)
    while device.port.sample().width_m > 0.075:
        await bus.clock.sleep(0.005)
    inject()
    result = await handle.result()
    # The command that withdraws the motion is still under way.
    await device.report(readings=5)
    cause = result.cause.because if result.cause is not None else None
    return result.status, cause.message if cause is not None else ""


@pytest.mark.parametrize("connection", CONNECTIONS)
def test_a_gripper_with_a_fault_has_it_again(connection: str, tmp_path: Path) -> None:
    async def scenario(emulator: EmulatedProcess, inject: Inject, capture: Path | None) -> tuple[GoalStatus, str]:
        async with driven(emulator, enable=True, capture=capture) as (bus, device):
            return await grasp_until_fault(bus, device, inject)

    with emulated(connection) as emulator:
        before = asyncio.run(scenario(emulator, lambda: emulator.do("fault", code=OVER_TEMPERATURE), capture=tmp_path))
    gc.collect()  # the capture ends with its device
    (file,) = tmp_path.iterdir()
    with replayed(file) as replay:
        after = asyncio.run(scenario(replay, nothing, None))
        assert replay.do("state")["mismatch"] == ""
    assert before[0] is GoalStatus.ABORTED
    assert "over-temperature" in before[1]
    assert after == before


@pytest.mark.parametrize("connection", HAND_CONNECTIONS)
def test_a_hand_that_closed_on_a_part_closes_on_it_again(connection: str, tmp_path: Path) -> None:
    """Its references depend on time: those of the replay are others, and are read back as they were sent."""

    async def close(bus: SkillBus, device: SoftHand, inject: Inject) -> tuple[bool, str, float]:
        await bus.send_goal(HandOpen(), to=SOFT_HAND).result()
        inject()
        closed = await bus.send_goal(HandClose(percent=100.0, time_s=2.0), to=SOFT_HAND).result()
        assert closed.result is not None
        return closed.result.held, closed.result.part, closed.result.closed_percent

    async def scenario(emulator: EmulatedProcess, inject: Inject, capture: Path | None) -> tuple[bool, str, float]:
        async with driven_hand(emulator, enable=True, capture=capture) as (bus, device):
            return await close(bus, device, inject)

    with emulated_hand(connection) as emulator:
        before = asyncio.run(scenario(emulator, lambda: emulator.do("object", share=0.5), capture=tmp_path))
    gc.collect()  # the capture ends with its device
    (file,) = tmp_path.iterdir()
    with replayed(file) as replay:
        after = asyncio.run(scenario(replay, nothing, None))
        assert replay.do("state")["mismatch"] == ""
    assert before[:2] == after[:2] == (True, "?")
    assert after[2] == pytest.approx(before[2], abs=1.0)


def test_a_driver_that_does_something_else_is_cut_off_with_the_reason(tmp_path: Path) -> None:
    async def grasp(emulator: EmulatedProcess, force_n: float, capture: Path | None = None) -> GoalStatus:
        async with driven(emulator, enable=True, capture=capture) as (bus, _):
            goal = GripperGrasp(width_m=0.05, force_n=force_n, speed_m_s=0.15)
            return (await bus.send_goal(goal, to=HAND).result()).status

    with emulated("urcap") as emulator:
        assert asyncio.run(grasp(emulator, 60.0, tmp_path)) is GoalStatus.SUCCEEDED
    gc.collect()  # the capture ends with its device
    (file,) = tmp_path.iterdir()
    with replayed(file) as replay:
        assert asyncio.run(grasp(replay, 100.0)) is GoalStatus.ABORTED
        mismatch = replay.do("state")["mismatch"]
    assert "offset " in mismatch
    assert "received the command " + b"SET ACT 1 GTO 1".hex(" ") in mismatch

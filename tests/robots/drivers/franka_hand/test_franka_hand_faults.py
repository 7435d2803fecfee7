"""The fault matrix of the Franka Hand, and what a person permits: its homing moves the fingers."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Generator

import pytest

from engine.bus import GoalStatus, Holder
from engine.clock import new_clock, run_virtual
from engine.errors import CellError, FlexcellError, RobotError
from engine.skills.devices import EnableDevice
from engine.skills.gripper import GripperOpen
from robots.drivers.franka_hand.franka_hand_options import FrankaHandOptions
from robots.drivers.franka_hand.new_franka_hand import new_franka_hand
from robots.port import MotionEnd
from tests.robots.drivers.emulated_device import Emulators, tool_context
from tests.robots.drivers.emulated_gripper import HAND
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_motion import faulty_motion
from tests.robots.drivers.franka.emulated_cabinet import needs_franka
from tests.robots.drivers.franka_hand.emulated_franka_hand import driven_franka_hand, emulated_franka_hand
from tests.robots.drivers.franka_hand.faulty_franka_hand import FAULTY_FRANKA_HAND, FRANKA_HAND_CASES

pytestmark = needs_franka


@pytest.fixture(scope="module")
def emulators() -> Generator[Emulators]:
    """The emulator of this file, started at its first use."""
    with Emulators(emulated_franka_hand) as started:
        yield started


@pytest.mark.parametrize("case", FRANKA_HAND_CASES, ids=lambda case: case.name)
def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(emulators: Emulators, case: FaultCase) -> None:
    outcome = asyncio.run(faulty_motion(FAULTY_FRANKA_HAND, emulators.of("fci"), case))
    assert outcome.status is GoalStatus.ABORTED
    assert any(cause in outcome.cause for cause in case.cause), outcome.cause
    assert bool(outcome.lost_reason) is case.lost
    assert all(outcome.refused), "every goal before the person's command is refused with a reason"
    assert outcome.commands_after == 0
    # The fingers of the simulated hand creep to where they rest.
    assert outcome.moved_after < 0.002
    assert outcome.moves_again


def test_the_hand_is_homed_by_a_person_and_by_no_run(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("fci")
        emulator.do("homed", on=False)
        homings = emulator.do("state")["homings"]
        async with driven_franka_hand(emulator) as (bus, device):
            assert (await device.report(readings=3)).state == "not homed"
            with pytest.raises(RobotError, match="not homed"):
                device.port.close_to(width_m=0.02, speed_m_s=0.05, force_n=20.0)
            bus.leases.acquire((HAND,), Holder("run-1"))
            with pytest.raises(FlexcellError, match="commanded by run run-1"):
                await bus.call(EnableDevice(reason="a behavior"), to=HAND)
            bus.leases.release_run("run-1")
            assert emulator.do("state")["homings"] == homings
            assert (await bus.call(EnableDevice(reason="Ann: fingers are clear"), to=HAND)).enabled
            assert emulator.do("state")["homings"] == homings + 1
            # Once homed, it is not homed again: that would drop what it holds.
            assert (await bus.call(EnableDevice(reason="again"), to=HAND)).enabled
            assert emulator.do("state")["homings"] == homings + 1

    asyncio.run(scenario())


def test_the_hand_stops_while_the_event_loop_is_blocked(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("fci")
        emulator.do("object", width_m=None)
        async with driven_franka_hand(emulator, enable=True) as (bus, device):
            await bus.send_goal(GripperOpen(speed_m_s=0.1), to=HAND).result()
            motion = device.port.close_to(width_m=0.0, speed_m_s=0.005, force_n=20.0)
            while device.port.sample().width_m > 0.075:
                await bus.clock.sleep(0.01)
            threading.Event().wait(1.5)
            stopped_m = emulator.do("state")["width_m"]
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
            assert "the engine was silent for" in report.reason
            assert stopped_m > 0.03
            assert emulator.do("state")["width_m"] == pytest.approx(stopped_m, abs=0.001)

    asyncio.run(scenario())


def test_a_second_client_of_the_hand_is_turned_away(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("fci")
        async with driven_franka_hand(emulator) as (_, first):
            with pytest.raises(RobotError, match="the hand does not answer") as refused:
                async with driven_franka_hand(emulator, stale_s=0.5):
                    pass
            assert "no other client" in (refused.value.hint or "")
            assert (await first.report(readings=3)).state == "homed"

    asyncio.run(scenario())


def test_virtual_time_is_refused() -> None:
    async def scenario() -> None:
        with pytest.raises(CellError, match="no virtual time"):
            new_franka_hand(FrankaHandOptions(host="127.0.0.1"), name=HAND, clock=new_clock(), context=tool_context())

    run_virtual(scenario())

"""The fault matrix of the Robotiq driver: each fault over each transport, in the middle of a motion."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Generator

import pytest

from engine.bus import GoalStatus, Holder
from engine.errors import FlexcellError, RobotError
from engine.messages.device_state import DeviceState
from engine.skills.devices import EnableDevice
from engine.skills.gripper import GripperMove, GripperOpen, ReadGripper
from robots.port import MotionEnd
from tests.robots.drivers.emulated_device import Emulators
from tests.robots.drivers.emulated_gripper import CONNECTIONS, HAND, driven, emulated
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_gripper import CASES, FAULTY_GRIPPER
from tests.robots.drivers.faulty_motion import faulty_motion


@pytest.fixture(scope="module")
def emulators() -> Generator[Emulators]:
    """The emulators of this file, each started at its first use."""
    with Emulators(emulated) as started:
        yield started


@pytest.mark.parametrize("connection", CONNECTIONS)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(
    emulators: Emulators, case: FaultCase, connection: str
) -> None:
    outcome = asyncio.run(faulty_motion(FAULTY_GRIPPER, emulators.of(connection), case))
    assert outcome.status is GoalStatus.ABORTED
    assert any(cause in outcome.cause for cause in case.cause), outcome.cause
    assert outcome.noticed_s < 20.0
    assert bool(outcome.lost_reason) is case.lost
    assert all(outcome.refused), "every goal before the person's command is refused with a reason"
    assert (outcome.commands_after, outcome.moved_after) == (0, 0.0)
    assert outcome.moves_again


@pytest.mark.parametrize("connection", ["modbus_tcp", "urcap"])
def test_a_second_client_on_a_connection_of_its_own_is_noticed_at_rest(emulators: Emulators, connection: str) -> None:
    async def scenario() -> None:
        emulator = emulators.of(connection)
        async with driven(emulator, enable=True) as (bus, device), driven(emulator, enable=True) as (others, _):
            await bus.send_goal(GripperMove(width_m=0.05, speed_m_s=0.15), to=HAND).result()
            await bus.clock.sleep(0.6)
            await others.send_goal(GripperMove(width_m=0.02, speed_m_s=0.15), to=HAND).result()
            await device.report(readings=3)
            end = await bus.send_goal(GripperOpen(), to=HAND).result()
            assert end.cause is not None
            assert "another client commands the gripper" in end.cause.chain()[-1].message

    asyncio.run(scenario())


def test_a_stale_reading_is_a_fault_and_no_value(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("modbus_tcp")
        async with driven(emulator, enable=True) as (bus, device):
            assert (await bus.call(ReadGripper(), to=HAND)).width_m >= 0.0
            emulator.do("freeze")
            while not device.lost_reason:
                await bus.clock.sleep(0.02)
            with pytest.raises(RobotError, match="no fresh reading"):
                await bus.call(ReadGripper(), to=HAND)
            state = bus.topic(f"{HAND}/device", DeviceState).latest
            assert state is not None
            assert (state.connected, state.enabled) == (False, False)
            with pytest.raises(RobotError):
                await device.reconnect()
            emulator.do("restore")

    asyncio.run(scenario())


def test_a_cancelled_motion_is_stopped_within_a_tenth_of_a_second(emulators: Emulators) -> None:
    """By the clock of the emulator, which is that of this machine; a loaded machine may be late, but not always."""

    async def scenario() -> list[float]:
        emulator, delays_s = emulators.of("rtu_over_tcp"), list[float]()
        emulator.do("object", width_m=None)
        async with driven(emulator, enable=True) as (bus, device):
            for _ in range(5):
                await bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
                motion = device.port.close_to(width_m=0.0, speed_m_s=0.02, force_n=30.0)
                while device.port.sample().width_m > 0.08:
                    await bus.clock.sleep(0.01)
                cancelled_s = time.monotonic()
                motion.cancel()
                assert (await motion.report()).end is MotionEnd.CANCELED
                delays_s.append(emulator.do("state")["stopped_s"] - cancelled_s)
        return delays_s

    delays_s = asyncio.run(scenario())
    assert min(delays_s) >= 0.0
    assert min(delays_s) < 0.1
    assert max(delays_s) < 2.0


def test_the_fingers_are_stopped_while_the_event_loop_is_blocked(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("urcap")
        emulator.do("object", width_m=None)
        async with driven(emulator, enable=True) as (bus, device):
            await bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
            motion = device.port.close_to(width_m=0.0, speed_m_s=0.02, force_n=30.0)
            while device.port.sample().width_m > 0.08:
                await bus.clock.sleep(0.01)
            threading.Event().wait(1.5)
            report = await motion.report()
            assert report.end is MotionEnd.FAILED
            assert "the engine was silent for" in report.reason
            state = emulator.do("state")
            assert (state["go"], state["width_m"] > 0.03) == (False, True)

    asyncio.run(scenario())


def test_fingers_that_are_moved_on_after_that_stop_are_stopped_too(emulators: Emulators) -> None:
    """A callback that waited while the event loop was blocked resumes the motion before it hears of the stop."""

    async def scenario() -> None:
        emulator = emulators.of("urcap")
        emulator.do("object", width_m=None)
        async with driven(emulator, enable=True) as (bus, device):
            await bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
            motion = device.port.close_to(width_m=0.0, speed_m_s=0.02, force_n=30.0)
            while device.port.sample().width_m > 0.08:
                await bus.clock.sleep(0.01)
            await motion.hold()
            resumed = asyncio.create_task(motion.resume())
            threading.Event().wait(1.5)
            report = await motion.report()
            await resumed
            assert "the engine was silent for" in report.reason
            await device.report(readings=20)
            state = emulator.do("state")
            assert (state["go"], state["width_m"] > 0.03) == (False, True)
            assert device.device_state().problem == ""

    asyncio.run(scenario())


def test_a_person_enables_and_no_run_does() -> None:
    """Connecting and reading activate nothing."""

    async def scenario() -> None:
        with emulated("modbus_tcp", active=False) as emulator:
            async with driven(emulator) as (bus, device):
                assert "not activated" in (await device.report(readings=5)).state
                assert emulator.do("state")["commands"] == 0
                bus.leases.acquire((HAND,), Holder("run-1"))
                with pytest.raises(FlexcellError, match="commanded by run run-1"):
                    await bus.call(EnableDevice(reason="a behavior"), to=HAND)
                bus.leases.release_run("run-1")
                emulator.do("fault", code=8)
                with pytest.raises(FlexcellError, match="cannot be enabled: over-temperature"):
                    await bus.call(EnableDevice(reason="too early"), to=HAND)
                emulator.do("fault", code=0)
                assert (await bus.call(EnableDevice(reason="cold again"), to=HAND)).enabled

    asyncio.run(scenario())


def test_an_object_around_the_fingers_is_detected_while_opening(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("serial")
        emulator.do("object", width_m=None)
        async with driven(emulator, enable=True) as (bus, device):
            await bus.send_goal(GripperMove(width_m=0.02, speed_m_s=0.15), to=HAND).result()
            emulator.do("ring", width_m=0.06)
            motion = device.port.close_to(width_m=0.085, speed_m_s=0.15, force_n=30.0)
            report = await motion.report()
            emulator.do("ring", width_m=None)
            assert (report.end, report.contact) == (MotionEnd.REACHED, True)
            sample = device.port.sample()
            assert sample.contacts == ("?", "?")
            assert sample.width_m == pytest.approx(0.06, abs=0.001)

    asyncio.run(scenario())


def test_a_device_that_is_not_there_says_where_and_what_to_check() -> None:
    async def scenario() -> None:
        with emulated("modbus_tcp") as emulator:
            emulator.do("cut")
            with pytest.raises(RobotError, match=r"does not answer: 127\..*cannot connect.*check supply and network"):
                async with driven(emulator):
                    pass

    asyncio.run(scenario())

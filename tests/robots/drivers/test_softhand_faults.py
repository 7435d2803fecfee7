"""The fault matrix of the SoftHand driver: each fault over each line, in the middle of a motion."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Generator

import msgspec
import pytest

from engine.bus import GoalStatus, Holder
from engine.clock import new_clock
from engine.errors import CellError, FlexcellError, RobotError
from engine.messages.device_state import DeviceState
from engine.skills.devices import EnableDevice
from engine.skills.hand import HandClose, HandOpen, ReadHand
from robots.drivers.softhand.new_softhand import new_softhand
from robots.drivers.softhand.softhand_options import SoftHandOptions
from robots.port import MotionEnd
from tests.robots.drivers.emulated_device import Emulators, tool_context
from tests.robots.drivers.emulated_hand import HAND, HAND_CONNECTIONS, driven_hand, emulated_hand
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_hand import FAULTY_HAND, HAND_CASES
from tests.robots.drivers.faulty_motion import faulty_motion


@pytest.fixture(scope="module")
def emulators() -> Generator[Emulators]:
    """The emulators of this file, each started at its first use."""
    with Emulators(emulated_hand) as started:
        yield started


@pytest.mark.parametrize("connection", HAND_CONNECTIONS)
@pytest.mark.parametrize("case", HAND_CASES, ids=lambda case: case.name)
def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(
    emulators: Emulators, case: FaultCase, connection: str
) -> None:
    outcome = asyncio.run(faulty_motion(FAULTY_HAND, emulators.of(connection), case))
    assert outcome.status is GoalStatus.ABORTED
    assert any(cause in outcome.cause for cause in case.cause), outcome.cause
    assert outcome.noticed_s < 20.0
    assert bool(outcome.lost_reason) is case.lost
    assert all(outcome.refused), "every goal before the person's command is refused with a reason"
    assert (outcome.commands_after, outcome.moved_after) == (0, 0.0)
    assert outcome.moves_again


def test_a_stale_reading_is_a_fault_and_no_value(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("tcp")
        async with driven_hand(emulator, enable=True) as (bus, device):
            assert (await bus.call(ReadHand(), to=HAND)).closed_percent >= 0.0
            emulator.do("freeze")
            while not device.lost_reason:
                await bus.clock.sleep(0.02)
            with pytest.raises(RobotError, match="no fresh reading"):
                await bus.call(ReadHand(), to=HAND)
            state = bus.topic(f"{HAND}/device", DeviceState).latest
            assert state is not None
            assert (state.connected, state.enabled) == (False, False)
            with pytest.raises(RobotError):
                await device.reconnect()
            emulator.do("restore")

    asyncio.run(scenario())


def test_the_hand_stops_while_the_event_loop_is_blocked(emulators: Emulators) -> None:
    """Its reference comes from the event loop; the connection holds the last one."""

    async def scenario() -> None:
        emulator = emulators.of("serial")
        async with driven_hand(emulator, enable=True) as (bus, device):
            await bus.send_goal(HandOpen(), to=HAND).result()
            motion = device.port.close_to(share=1.0, time_s=8.0)
            while device.port.sample().closed_share < 0.1:
                await bus.clock.sleep(0.01)
            before = emulator.do("state")
            threading.Event().wait(1.5)
            stopped = emulator.do("state")
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
            assert "the engine was silent for" in report.reason
            # A quarter of the stroke would have passed else.
            assert stopped["position_ticks"] - before["position_ticks"] < 2000
            assert not stopped["moving"]

    asyncio.run(scenario())


def test_a_person_enables_without_any_motion_and_no_run_does() -> None:
    """Connecting and reading activate nothing; the activation holds the present position."""

    async def scenario() -> None:
        with emulated_hand("serial", active=False) as emulator:
            async with driven_hand(emulator) as (bus, device):
                assert (await device.report(readings=5)).state == "not activated"
                assert emulator.do("state")["commands"] == 0
                bus.leases.acquire((HAND,), Holder("run-1"))
                with pytest.raises(FlexcellError, match="commanded by run run-1"):
                    await bus.call(EnableDevice(reason="a behavior"), to=HAND)
                bus.leases.release_run("run-1")
                emulator.do("foreign", ticks=12000)
                emulator.do("current", current_ma=2000)
                with pytest.raises(FlexcellError, match="cannot be enabled: over-current"):
                    await bus.call(EnableDevice(reason="too early"), to=HAND)
                emulator.do("current", current_ma=0)
                await device.report(readings=5)
                assert (await bus.call(EnableDevice(reason="cleared"), to=HAND)).enabled
                state = emulator.do("state")
                assert (state["active"], state["travel"], state["reference_ticks"]) == (True, 0.0, 0)

    asyncio.run(scenario())


def test_a_blocked_hand_pulls_up_to_its_current_limit_and_no_more(emulators: Emulators) -> None:
    async def scenario() -> None:
        emulator = emulators.of("tcp")
        async with driven_hand(emulator, enable=True, current_limit_ma=500.0) as (bus, device):
            await bus.send_goal(HandOpen(), to=HAND).result()
            emulator.do("object", share=0.5)
            closed = await bus.send_goal(HandClose(percent=100.0, time_s=4.0), to=HAND).result()
            assert closed.result is not None
            assert (closed.result.held, closed.result.part) == (True, "?")
            assert closed.result.closed_percent == pytest.approx(50.0, abs=1.0)
            state = emulator.do("state")
            # The reference runs on for one reading at most, a few on a loaded machine.
            assert 500 <= state["current_ma"] < 900
            assert device.port.sample().force_n == pytest.approx(0.2 * (state["current_ma"] - 160.0), abs=1.0)
            emulator.do("object", share=None)
            await bus.send_goal(HandOpen(), to=HAND).result()

    asyncio.run(scenario())


@pytest.mark.parametrize("share", [0.0, 0.8])
def test_a_motor_that_does_not_turn_is_no_grasp_and_no_open_hand(emulators: Emulators, share: float) -> None:
    async def scenario() -> None:
        emulator = emulators.of("tcp")
        async with driven_hand(emulator, enable=True) as (bus, device):
            await bus.send_goal(HandClose(percent=40.0), to=HAND).result()
            emulator.do("stuck", on=True)
            report = await device.port.close_to(share=share, time_s=0.5).report()
            emulator.do("stuck", on=False)
            assert report.end is MotionEnd.FAILED
            assert f"the fingers stopped at 7600 ticks instead of {round(share * 19000)}" in report.reason
            assert (await device.port.close_to(share=0.0, time_s=1.0).report()).end is MotionEnd.REACHED

    asyncio.run(scenario())


def test_a_cancelled_grasp_still_pulls(emulators: Emulators) -> None:
    """Stopped while it presses, the hand keeps its reference, and what it holds stays held."""

    async def scenario() -> None:
        emulator = emulators.of("serial")
        async with driven_hand(emulator, enable=True) as (bus, device):
            await bus.send_goal(HandOpen(), to=HAND).result()
            emulator.do("object", share=0.3)
            motion = device.port.close_to(share=1.0, time_s=20.0)
            while not device.port.sample().contacts[0]:
                await bus.clock.sleep(0.01)
            motion.cancel()
            assert (await motion.report()).end is MotionEnd.CANCELED
            sample = device.port.sample()
            assert set(sample.contacts) == {"?"}
            assert sample.force_n > 0.03 * device.port.max_force_n
            emulator.do("object", share=None)
            await bus.send_goal(HandOpen(), to=HAND).result()

    asyncio.run(scenario())


def test_a_device_that_is_not_there_says_where_and_what_to_check() -> None:
    async def scenario() -> None:
        with emulated_hand("tcp") as emulator:
            emulator.do("cut")
            with pytest.raises(
                RobotError, match=r"does not answer: socket://127\..*cannot connect.*check supply, cable"
            ):
                async with driven_hand(emulator):
                    pass

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"free_ma": ((0.5, 60.0), (0.5, 260.0))}, "rising shares"),
        ({"current_limit_ma": 800.0, "fault_ma": 700.0}, "must be greater than"),
    ],
)
async def test_a_calibration_that_is_none_is_refused(options: dict[str, object], message: str) -> None:
    chosen = msgspec.convert({"kind": "softhand", "device": "/dev/null", **options}, SoftHandOptions)
    with pytest.raises(CellError, match=message):
        new_softhand(chosen, name=HAND, clock=new_clock(), context=tool_context())

"""The homing of a Franka Hand on a transport in memory: it moves the fingers, can be stopped, and has an end."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable

import pytest

from engine.cell.drivers import DeviceReport
from engine.errors import RobotError
from robots.drivers.franka_hand.franka_hand import FrankaHand
from robots.drivers.franka_hand.franka_hand_reading import (
    FrankaHandCommand,
    FrankaHandReading,
    HomeFingers,
    StopFingers,
)
from robots.drivers.franka_hand.hand_protocol import FingerState, HandReply
from robots.drivers.fresh_link import LinkTiming
from tests.robots.sim.sim_cell import until

STROKE_M = 0.08
ABOUT = DeviceReport(device="hand", driver="franka_hand", address="memory", proven="")


class HandInMemory:
    """Implements `DeviceTransport`: a hand that homes until it is told the end."""

    address = "memory"
    remedy = "none"

    def __init__(self) -> None:
        self.reading = FrankaHandReading(
            state=FingerState(number=1, width_m=0.04, stroke_m=0.0, is_grasping=False, temperature_c=30)
        )
        self.homing = 0
        self.commands: list[FrankaHandCommand] = []

    def open(self) -> None:
        """Nothing to open."""

    def close(self) -> None:
        """Nothing to close."""

    def read(self) -> FrankaHandReading:
        """Return what was set."""
        return self.reading

    def write(self, command: FrankaHandCommand) -> None:
        """Note a command; a stop aborts the homing."""
        self.commands.append(command)
        match command:
            case HomeFingers():
                self.homing = command.number
            case StopFingers() if self.homing:
                self.end(HandReply.ABORTED, stroke_m=0.0)
            case _:
                pass

    def end(self, status: HandReply, *, stroke_m: float) -> None:
        """End the homing."""
        state = FingerState(number=2, width_m=0.04, stroke_m=stroke_m, is_grasping=False, temperature_c=30)
        self.reading = FrankaHandReading(state=state, ended=self.homing, end_status=int(status))
        self.homing = 0


def homed(scenario: Callable[[HandInMemory, FrankaHand, asyncio.Task[None]], object]) -> HandInMemory:
    """Play a scenario in the middle of a homing that a person has asked for."""

    async def play() -> HandInMemory:
        hand = HandInMemory()
        timing = LinkTiming(period_s=0.005, stale_s=5.0)
        async with FrankaHand("hand", hand, timing=timing, about=ABOUT) as device:
            enabling = asyncio.create_task(device.enable("a test"))
            async with asyncio.timeout(20.0):
                await until(lambda: bool(hand.homing))
                result = scenario(hand, device, enabling)
                if asyncio.iscoroutine(result):
                    await result
                await asyncio.wait((enabling,))
        return hand

    return asyncio.run(play())


def test_stop_stops_the_fingers_in_the_middle_of_a_homing() -> None:
    async def stopped(_: HandInMemory, device: FrankaHand, enabling: asyncio.Task[None]) -> None:
        await device.stop()
        with pytest.raises(RobotError, match="was stopped while it was enabled"):
            await enabling

    hand = homed(stopped)
    assert [type(command) for command in hand.commands] == [HomeFingers, StopFingers]


def test_the_hand_is_not_enabled_before_its_homing_has_ended() -> None:
    async def ended(hand: HandInMemory, device: FrankaHand, enabling: asyncio.Task[None]) -> None:
        # The stroke is known while the fingers still move.
        hand.reading = FrankaHandReading(
            state=FingerState(number=2, width_m=0.02, stroke_m=STROKE_M, is_grasping=False, temperature_c=30)
        )
        await device.report(readings=3)
        assert not enabling.done()
        hand.end(HandReply.SUCCESS, stroke_m=STROKE_M)
        await enabling
        assert device.device_state().enabled

    homed(ended)


def test_a_homing_that_fails_is_not_waited_for() -> None:
    async def failed(hand: HandInMemory, _: FrankaHand, enabling: asyncio.Task[None]) -> None:
        hand.end(HandReply.FAIL, stroke_m=0.0)
        with pytest.raises(RobotError, match="cannot be enabled: the homing has measured no stroke"):
            await enabling

    homed(failed)


def test_a_homing_that_nobody_waits_for_any_more_is_stopped() -> None:
    async def canceled(hand: HandInMemory, _: FrankaHand, enabling: asyncio.Task[None]) -> None:
        enabling.cancel()
        await asyncio.wait((enabling,))
        await until(lambda: not hand.homing)

    homed(canceled)


def test_an_engine_that_is_silent_in_the_middle_of_a_homing_has_the_fingers_stopped() -> None:
    def silent(hand: HandInMemory, _: FrankaHand, enabling: asyncio.Task[None]) -> None:
        waited = threading.Event()
        for _period in range(200):
            if not hand.homing:
                break
            waited.wait(0.05)
        assert not hand.homing
        enabling.cancel()

    homed(silent)

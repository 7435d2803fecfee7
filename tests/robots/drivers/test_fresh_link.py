"""A link reads in its own thread, says how fresh a reading is, and keeps no command over a failure."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest

from engine.clock import new_clock
from engine.errors import RobotError
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.io.wire.link_error import LinkError

TIMING = LinkTiming(period_s=0.005, stale_s=0.2, silence_s=0.15)


class FakeTransport:
    """Counts, and fails while `fails` says why."""

    address = "nowhere:1"
    remedy = "check the fake"

    def __init__(self) -> None:
        self.fails = ""
        self.defect = False
        self.opened = self.closed = self.failing_stops = 0
        self.value: float | None = None
        self.log: list[str] = []

    def open(self) -> None:
        self._check()
        self.opened += 1

    def close(self) -> None:
        self.closed += 1

    def read(self) -> float:
        self._check()
        self.log.append("read")
        return len(self.log) if self.value is None else self.value

    def write(self, command: str) -> None:
        self._check()
        if command == "stop" and self.failing_stops:
            self.failing_stops -= 1
            raise LinkError("it broke in the stop")
        self.log.append(command)

    def _check(self) -> None:
        if self.defect:
            raise ZeroDivisionError
        if self.fails:
            raise LinkError(self.fails)


class Listener:
    """Notes what it hears."""

    def __init__(self) -> None:
        self.readings = 0
        self.events: list[str] = []

    def read(self, reading: FreshReading[float]) -> None:
        self.readings += 1

    def lost(self, reason: str) -> None:
        self.events.append(f"lost: {reason}")

    def found(self) -> None:
        self.events.append("found")

    def stopped_by_silence(self, silent_s: float) -> None:
        self.events.append("silence")


@asynccontextmanager
async def linked() -> AsyncGenerator[tuple[FreshLink[float, str], FakeTransport, Listener]]:
    transport, listener = FakeTransport(), Listener()
    link = FreshLink[float, str](transport, listener, TIMING)
    await link.start()
    try:
        yield link, transport, listener
    finally:
        await link.close()


async def until_heard(listener: Listener, event: str) -> None:
    while not any(each.startswith(event) for each in listener.events):
        await new_clock().sleep(0.01)


async def test_a_device_that_never_answers_is_refused_with_its_address_and_what_to_check() -> None:
    transport = FakeTransport()
    transport.fails = "no answer"
    link = FreshLink[float, str](transport, Listener(), TIMING)
    with pytest.raises(RobotError, match=r"nowhere:1: no answer \(check the fake\)"):
        await link.start()
    await link.close()


async def test_readings_are_fresh_and_a_command_goes_before_the_next_one() -> None:
    async with linked() as (link, transport, listener):
        before_s = time.monotonic()
        written_s = await link.submit("go")
        assert before_s <= written_s <= time.monotonic()
        count = listener.readings
        while listener.readings < count + 3:
            await new_clock().sleep(0.005)
        assert link.fresh() > 0
        assert transport.log.count("go") == 1


async def test_a_lost_link_has_no_value_and_takes_no_command_and_comes_back_for_reading_only() -> None:
    async with linked() as (link, transport, listener):
        transport.fails = "the cable is out"
        await until_heard(listener, "lost")
        assert listener.events[0].startswith("lost: the cable is out; no fresh reading for ")
        with pytest.raises(RobotError, match="the cable is out"):
            link.fresh()
        with pytest.raises(RobotError, match="the cable is out"):
            await link.submit("go")
        transport.fails = ""
        await until_heard(listener, "found")
        assert link.fresh() > 0
        assert transport.opened == 2
        assert "go" not in transport.log


async def test_a_command_that_fails_is_not_repeated() -> None:
    async with linked() as (link, transport, listener):
        transport.fails = "a glitch"
        with pytest.raises(RobotError, match="a glitch"):
            await link.submit("go")
        transport.fails = ""
        count = listener.readings
        while listener.readings < count + 3:
            await new_clock().sleep(0.005)
        assert "go" not in transport.log


async def test_a_blocked_event_loop_is_stopped_for_once_while_a_motion_is_armed() -> None:
    async with linked() as (link, transport, listener):
        threading.Event().wait(0.4)
        assert "stop" not in transport.log
        link.arm("stop")
        threading.Event().wait(0.6)
        await until_heard(listener, "silence")
        assert transport.log.count("stop") == 1


async def test_a_stop_for_a_blocked_loop_that_fails_is_sent_over_the_next_connection() -> None:
    async with linked() as (link, transport, listener):
        transport.failing_stops = 1
        link.arm("stop")
        threading.Event().wait(0.6)
        await until_heard(listener, "silence")
        assert transport.log.count("stop") == 1
        assert transport.opened == 2


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
async def test_a_defect_of_a_transport_is_a_lost_device_and_no_silence() -> None:
    async with linked() as (link, transport, listener):
        transport.defect = True
        await until_heard(listener, "lost: the driver failed: ZeroDivisionError")
        with pytest.raises(RobotError, match="the driver failed"):
            link.fresh()
        await link.close()
        # A second driver of the device could not connect otherwise.
        assert transport.closed == 1


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
async def test_a_reading_that_is_not_finite_is_no_reading(value: float) -> None:
    async with linked() as (link, transport, listener):
        transport.value = value
        await until_heard(listener, "lost: invalid reading: the reading is ")
        assert link.latest is not None
        assert math.isfinite(link.latest.value)
        with pytest.raises(RobotError, match="invalid reading"):
            link.fresh()


async def test_a_device_that_is_closed_takes_no_command() -> None:
    async with linked() as (link, _, _listener):
        await link.close()
        with pytest.raises(RobotError, match="disconnected"):
            await link.submit("go")

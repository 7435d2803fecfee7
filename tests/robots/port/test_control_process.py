"""A control process brings its devices to rest when the engine is silent, in virtual time."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from robots.port.control_process import EngineMonitor
from robots.port.heartbeat import Heartbeat, new_heartbeat_file

PERIOD_S = 0.001


class Devices:
    """Moves until it is braked, and then for 50 looks more; implements `ControlledDevices`."""

    def __init__(self) -> None:
        self.causes: list[str] = []
        self.braking = 50
        self.moving = True

    @property
    def at_rest(self) -> bool:
        return not self.moving

    def brake(self, cause: str) -> None:
        self.causes.append(cause)
        self.braking -= 1
        self.moving = self.braking > 0


class Process:
    """A control process whose periods are passed by hand."""

    def __init__(self, heartbeat: Heartbeat) -> None:
        self.heartbeat = heartbeat
        self.devices = Devices()
        self.log: list[str] = []
        self.monitor = EngineMonitor(heartbeat, self.devices, log=self.log.append)
        self.now_s = 100.0

    def control(self, periods: int, *, pulse_every: int = 0) -> None:
        """Let control periods pass; the engine pulses every so many of them, or never."""
        for period in range(periods):
            if pulse_every and period % pulse_every == 0:
                self.heartbeat.beat_engine()
            self.now_s += PERIOD_S
            self.monitor.look(self.now_s)


@pytest.fixture
def process() -> Iterator[Process]:
    """A control process whose engine has not begun."""
    descriptor = new_heartbeat_file()
    heartbeat = Heartbeat(descriptor)
    os.close(descriptor)
    yield Process(heartbeat)
    heartbeat.close()


def test_nothing_is_braked_before_the_first_pulse_nor_while_the_engine_is_heard(process: Process) -> None:
    process.control(5000)
    process.control(5000, pulse_every=150)
    assert (process.devices.causes, process.log, process.heartbeat.control_count) == ([], [], 10_000)


def test_a_silent_engine_brakes_after_a_fifth_of_a_second_and_the_log_says_when_everything_rests(
    process: Process,
) -> None:
    process.control(1, pulse_every=1)
    process.control(198)
    assert process.devices.causes == []
    process.control(60)
    assert process.devices.causes[0] == "the engine has been silent for 0.2 s"
    rested_ns = process.heartbeat.at_rest_since_ns
    assert rested_ns == pytest.approx(100.25e9, abs=2e6)
    (line,) = process.log
    assert "everything came to rest 0.0" in line
    assert f"at {rested_ns / 1e9:.3f} s (monotonic)" in line


def test_the_log_gives_the_silence_that_braked_also_when_the_engine_is_back_before_everything_rests(
    process: Process,
) -> None:
    process.control(1, pulse_every=1)
    process.control(220)
    process.control(20, pulse_every=5)
    process.devices.moving = False
    process.control(1)
    (line,) = process.log
    assert line.startswith("the engine has been silent for 0.2 s; everything came to rest 0.0")


def test_nothing_is_braked_any_more_once_the_engine_pulses_again(process: Process) -> None:
    process.control(1, pulse_every=1)
    process.control(300)
    braked = len(process.devices.causes)
    process.control(300, pulse_every=40)
    assert braked > 50
    assert len(process.devices.causes) == braked


def test_what_begins_while_the_engine_is_silent_is_braked_with_the_silence_of_then(process: Process) -> None:
    process.control(1, pulse_every=1)
    process.control(1000)
    assert process.devices.causes[-1] == "the engine has been silent for 1.0 s"


def test_an_engine_that_is_gone_brakes_at_once_and_for_good(process: Process) -> None:
    process.control(10, pulse_every=1)
    process.monitor.engine_is_gone()
    process.control(100, pulse_every=1)
    assert set(process.devices.causes) == {"the engine has ended"}
    assert process.devices.at_rest
    assert process.log[0].startswith("the engine has ended; everything came to rest")


def test_a_control_process_that_was_suspended_hears_the_engine_before_it_judges(process: Process) -> None:
    process.control(1, pulse_every=1)
    process.now_s += 60.0
    process.control(100)
    assert process.devices.causes == []

"""A control process takes STOP by itself: it brakes while its line is latched, and says once that everything rests."""

from __future__ import annotations

import socket
from collections.abc import Generator
from dataclasses import dataclass, field

import pytest

from engine.stop import StopLine, StopNotice
from engine.stop.relay_messages import StopRelease, encode_message
from robots.port.stop_monitor import StopMonitor


@dataclass
class _Devices:
    """Devices that note with what they were told to brake."""

    at_rest: bool = False
    causes: list[str] = field(default_factory=list[str])

    def brake(self, cause: str) -> None:
        self.causes.append(cause)


@pytest.fixture
def wire() -> Generator[tuple[socket.socket, socket.socket]]:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        yield ours, theirs


def test_it_brakes_in_every_period_until_it_is_released(wire: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = wire
    devices = _Devices()
    monitor = StopMonitor(StopLine(ours), devices)
    monitor.look()
    theirs.send(encode_message(StopNotice(stop=1, reason="the door is open", source="http")))
    monitor.look()
    monitor.look()
    theirs.send(encode_message(StopRelease(stop=1)))
    monitor.look()
    assert devices.causes == ["STOP: the door is open"] * 2


def test_rest_is_reported_when_it_is_measured(wire: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = wire
    devices = _Devices()
    monitor = StopMonitor(StopLine(ours), devices)
    theirs.send(encode_message(StopNotice(stop=1, reason="test", source="http")))
    monitor.look()
    assert b'"at_rest":true' not in theirs.recv(4096)
    devices.at_rest = True
    monitor.look()
    assert b'"at_rest":true' in theirs.recv(4096)


def test_a_cut_line_is_a_stop(wire: tuple[socket.socket, socket.socket]) -> None:
    ours, theirs = wire
    devices = _Devices()
    monitor = StopMonitor(StopLine(ours), devices)
    theirs.close()
    monitor.look()
    monitor.look()
    assert devices.causes == ["STOP: the stop line is cut: the stop relay has ended"] * 2


def test_a_process_without_a_line_goes_on() -> None:
    devices = _Devices()
    StopMonitor(None, devices).look()
    assert not devices.causes

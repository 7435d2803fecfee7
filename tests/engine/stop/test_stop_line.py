"""The device's end of a stop line: what latches, what releases, what is answered."""

from __future__ import annotations

import socket
from collections.abc import Generator
from dataclasses import dataclass

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.stop import StopLine, StopNotice
from engine.stop.relay_messages import StopAcknowledgement, StopRelease, encode_message
from engine.stop.stop_line import CUT


@dataclass
class _Wire:
    line: StopLine
    relay: socket.socket

    def stop(self, number: int, reason: str = "test") -> None:
        self.relay.send(encode_message(StopNotice(stop=number, reason=reason, source="http")))

    def release(self, number: int) -> None:
        self.relay.send(encode_message(StopRelease(stop=number)))

    def answers(self) -> list[StopAcknowledgement]:
        data = self.relay.recv(65536)
        return [msgspec.json.decode(line, type=StopAcknowledgement) for line in data.splitlines()]


@pytest.fixture
def wire() -> Generator[_Wire]:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        yield _Wire(StopLine(ours), theirs)


def test_a_line_on_which_nothing_arrives_is_open(wire: _Wire) -> None:
    assert not wire.line.poll()
    assert not wire.line.latched


def test_a_stop_latches_and_is_acknowledged_and_rest_is_reported_once(wire: _Wire) -> None:
    wire.stop(1, "a hand")
    assert wire.line.poll() == "a hand"
    assert not wire.line.poll()
    assert (wire.line.latched, wire.line.reason) == (True, "a hand")
    wire.line.report_at_rest()
    wire.line.report_at_rest()
    assert wire.answers() == [StopAcknowledgement(stop=1, at_rest=False), StopAcknowledgement(stop=1, at_rest=True)]


def test_only_the_release_of_the_latest_stop_unlatches(wire: _Wire) -> None:
    wire.stop(1, "first")
    wire.stop(2, "second")
    wire.release(1)
    assert wire.line.poll()
    assert wire.line.reason == "second"
    wire.release(2)
    assert not wire.line.poll()
    assert not wire.line.latched


def test_a_stop_and_its_release_that_are_read_at_once_still_stop(wire: _Wire) -> None:
    wire.stop(1, "short")
    wire.release(1)
    assert wire.line.poll() == "short"
    assert not wire.line.latched


def test_a_cut_line_is_a_stop_that_nothing_releases(wire: _Wire) -> None:
    wire.relay.close()
    assert wire.line.poll()
    assert not wire.line.poll()
    assert wire.line.reason == CUT


@given(garbage=st.binary(min_size=1, max_size=200))
def test_garbage_never_raises_and_never_opens_the_latch(garbage: bytes) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        line = StopLine(ours)
        theirs.send(encode_message(StopNotice(stop=1, reason="test", source="http")))
        line.poll()
        theirs.send(garbage + b"\n")
        line.poll()
        assert line.latched

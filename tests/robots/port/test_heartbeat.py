"""Who is silent, in virtual time: never one that is heard, never because the observer itself was away."""

from __future__ import annotations

import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.port.heartbeat import Heartbeat, SilenceMonitor, new_heartbeat_file

LIMIT_S, GAP_S = 0.2, 0.05
GAPS_S = st.lists(st.floats(0.0, 0.03), min_size=1, max_size=60)


def monitor() -> SilenceMonitor:
    """Return a monitor that has heard its first pulse at 0."""
    found = SilenceMonitor(limit_s=LIMIT_S, longest_gap_s=GAP_S)
    found.look(1, 0.0)
    return found


@given(gaps_s=GAPS_S)
def test_a_peer_that_pulses_between_all_looks_is_never_silent(gaps_s: list[float]) -> None:
    looked, now_s = monitor(), 0.0
    for count, gap_s in enumerate(gaps_s, start=2):
        now_s += 100.0 * gap_s
        assert not looked.look(count, now_s)


@given(gaps_s=GAPS_S)
def test_one_that_does_not_pulse_is_silent_from_the_limit_on_and_not_before(gaps_s: list[float]) -> None:
    looked, now_s = monitor(), 0.0
    for gap_s in gaps_s:
        now_s += gap_s
        assert looked.look(1, now_s) == (looked.silent_s >= LIMIT_S)
        assert looked.silent_s == pytest.approx(now_s)


@given(away_s=st.floats(0.0, 1e6), heard_s=st.floats(0.0, 0.1))
def test_an_observer_that_was_away_looks_again_before_it_judges(away_s: float, heard_s: float) -> None:
    looked = monitor()
    assert not looked.look(1, heard_s)
    assert not looked.look(1, heard_s + away_s)


@given(gaps_s=GAPS_S)
def test_one_that_has_not_begun_is_not_silent(gaps_s: list[float]) -> None:
    """However long the engine opens its cell, or a world is compiled."""
    looked, now_s = SilenceMonitor(limit_s=LIMIT_S, longest_gap_s=GAP_S), 0.0
    for gap_s in gaps_s:
        now_s += 100.0 * gap_s
        assert not looked.look(0, now_s)


def test_a_pulse_after_a_silence_is_heard_at_once() -> None:
    looked = monitor()
    silent = [looked.look(1, 0.04 * turn) for turn in range(1, 8)]
    assert (silent[3], silent[6], looked.look(2, 0.3), looked.silent_s) == (False, True, False, 0.0)


def test_the_heartbeat_of_a_process_is_read_by_another_that_knows_its_number_only() -> None:
    descriptor = new_heartbeat_file()
    written = Heartbeat(descriptor)
    written.beat_engine()
    written.beat_control()
    written.report_at_rest(7)
    # This very process stands for the other one: what is opened is found through the system, not passed on.
    read = Heartbeat.of_process(os.getpid())
    assert (read.engine_count, read.control_count, read.at_rest_since_ns) == (1, 1, 7)
    for each in (written, read):
        each.close()
    os.close(descriptor)


def test_a_process_without_a_heartbeat_is_reported() -> None:
    with pytest.raises(FileNotFoundError, match="has no heartbeat"):
        Heartbeat.of_process(os.getpid())

"""The event loop has its turn sooner than Python gives it by itself."""

from __future__ import annotations

import sys

import pytest

from engine.host.thread_switch_interval import INTERVAL_S, short_switch_interval


def test_the_interval_is_short_inside_and_as_before_afterwards() -> None:
    """A process may go on with something else."""
    before = sys.getswitchinterval()
    with short_switch_interval():
        inside = sys.getswitchinterval()
    assert (inside, sys.getswitchinterval()) == (pytest.approx(INTERVAL_S), pytest.approx(before))


def test_a_shorter_interval_stays() -> None:
    """Of who looks for races, say."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        with short_switch_interval():
            assert sys.getswitchinterval() == pytest.approx(1e-5)
    finally:
        sys.setswitchinterval(before)

"""Percentiles of lateness from a histogram."""

from __future__ import annotations

import pytest

from robots.sim.timing import TimingCounter, timing_of


def test_percentiles_maximum_overruns_and_slips_are_counted() -> None:
    counter = TimingCounter()
    for _ in range(98):
        counter.count(late_s=52e-6, overrun=False)
    counter.count(late_s=1.5e-3, overrun=True)
    counter.count(late_s=0.5, overrun=True)
    counter.slip(0.4)
    timing = timing_of(counter.values)
    assert (timing.steps, timing.overruns, timing.slipped_s, timing.late_max_s) == (100, 2, 0.4, 0.5)
    assert timing.late_p50_s == pytest.approx(55e-6)
    assert timing.late_p99_s == pytest.approx(1.5e-3, abs=6e-6)


def test_a_loop_that_never_ran_has_zeros() -> None:
    timing = timing_of(TimingCounter().values)
    assert (timing.steps, timing.late_p50_s, timing.late_p99_s, timing.late_max_s) == (0, 0.0, 0.0, 0.0)

"""Percentiles of lateness from a histogram."""

from __future__ import annotations

import pytest

from robots.sim.host.loop_timing import TimingCounter, decode_timing


def test_percentiles_maximum_overruns_and_slips_are_counted() -> None:
    counter = TimingCounter()
    for _ in range(98):
        counter.count(late_s=52e-6, overrun=False)
    counter.count(late_s=1.5e-3, overrun=True)
    counter.count(late_s=0.5, overrun=True)
    counter.slip(0.4)
    timing = decode_timing(counter.values)
    assert (timing.steps, timing.overruns, timing.slipped_s, timing.late_max_s) == (100, 2, 0.4, 0.5)
    assert timing.late_p50_s == pytest.approx(55e-6)
    assert timing.late_p99_s == pytest.approx(1.5e-3, abs=6e-6)


def test_a_loop_that_never_ran_has_zeros() -> None:
    timing = decode_timing(TimingCounter().values)
    assert (timing.steps, timing.late_p50_s, timing.late_p99_s, timing.late_max_s) == (0, 0.0, 0.0, 0.0)


def test_what_happened_before_a_moment_does_not_count_after_it() -> None:
    """Neither the late start nor the overrun of the first part; the maximum is that of the second."""
    counter = TimingCounter()
    for late_s, overrun in ((5e-3, True), (52e-6, False)):
        counter.count(late_s=late_s, overrun=overrun)
    counter.slip(0.3)
    earlier = decode_timing(counter.values)
    for late_s in (11e-6, 21e-6, 31e-6, 92e-6):
        counter.count(late_s=late_s, overrun=late_s > 90e-6)
    timing = decode_timing(counter.values).since(earlier)
    assert (timing.steps, timing.overruns, timing.slipped_s) == (4, 1, 0.0)
    assert (timing.late_p50_s, timing.late_p99_s) == pytest.approx((25e-6, 95e-6))
    assert timing.late_max_s == pytest.approx(95e-6)


def test_the_greatest_delay_of_all_is_known_exactly_also_after_a_moment() -> None:
    counter = TimingCounter()
    counter.count(late_s=1e-3, overrun=False)
    earlier = decode_timing(counter.values)
    counter.count(late_s=1.234e-3, overrun=False)
    assert decode_timing(counter.values).since(earlier).late_max_s == 1.234e-3
    assert decode_timing(counter.values).since(decode_timing(counter.values)).late_max_s == 0.0

"""Intervals of success rates against known truth and against each other."""

from __future__ import annotations

import random
from functools import cache

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.sweep.statistics import RatePair, difference, exact_interval, rate_interval


@st.composite
def counts(draw: st.DrawFn) -> tuple[int, int]:
    runs = draw(st.integers(0, 3000))
    return draw(st.integers(0, runs)), runs


@given(counts(), st.floats(0.5, 0.999))
def test_an_interval_contains_the_share_and_stays_between_0_and_1(found: tuple[int, int], confidence: float) -> None:
    successes, runs = found
    interval = rate_interval(successes, runs, confidence=confidence)
    assert 0.0 <= interval.low <= (successes / runs if runs else 0.5) <= interval.high <= 1.0


@given(counts())
def test_an_interval_for_all_times_is_wider_than_the_exact_one(found: tuple[int, int]) -> None:
    at_any_time, fixed = rate_interval(*found), exact_interval(*found)
    assert at_any_time.low <= fixed.low + 1e-9
    assert at_any_time.high >= fixed.high - 1e-9


@given(counts())
def test_successes_and_failures_mirror_each_other(found: tuple[int, int]) -> None:
    successes, runs = found
    interval, mirrored = rate_interval(successes, runs), rate_interval(runs - successes, runs)
    assert interval.low == pytest.approx(1.0 - mirrored.high, abs=1e-9)


@given(st.integers(0, 200), st.integers(1, 200), st.floats(0.5, 0.9))
def test_more_confidence_needs_a_wider_interval(successes: int, failures: int, confidence: float) -> None:
    runs = successes + failures
    less, more = rate_interval(successes, runs, confidence=confidence), rate_interval(successes, runs, confidence=0.99)
    assert more.low <= less.low
    assert more.high >= less.high


@pytest.mark.parametrize("rate", [0.5, 0.9, 0.97, 0.99])
def test_intervals_after_every_run_exclude_the_rate_in_few_sweeps(rate: float) -> None:
    """Of 100 sweeps of 300 runs; with error 5 % the probability of more than 14 is below 0.0002."""
    excluded = sum(_excludes(rate, random.Random(f"{rate} {sweep}")) for sweep in range(100))
    assert excluded <= 14


def test_the_exact_interval_after_every_run_excludes_it_far_more_often() -> None:
    """Why it is only for a fixed number of runs."""
    excluded = sum(_excludes(0.9, random.Random(f"exact {sweep}"), exact=True) for sweep in range(40))
    assert excluded >= 8


def _excludes(rate: float, source: random.Random, *, exact: bool = False) -> bool:
    successes = 0
    for runs in range(1, 301):
        successes += source.random() < rate
        interval = (_exact_interval if exact else _rate_interval)(successes, runs)
        if not interval.low <= rate <= interval.high:
            return True
    return False


# Sweeps of the same rate have many counts in common.
_exact_interval = cache(exact_interval)
_rate_interval = cache(rate_interval)


@pytest.mark.parametrize(
    ("successes", "runs", "low", "high"),
    [
        # Clopper and Pearson (1934) as tabulated in NIST/SEMATECH e-Handbook, section 7.2.4.1: 4 of 20.
        (4, 20, 0.057334, 0.436614),
        (0, 10, 0.0, 0.308498),
        (10, 10, 0.691503, 1.0),
    ],
)
def test_the_exact_interval_is_that_of_clopper_and_pearson(successes: int, runs: int, low: float, high: float) -> None:
    assert tuple(exact_interval(successes, runs)) == pytest.approx((low, high), abs=2e-6)


@pytest.mark.parametrize(("successes", "runs"), [(-1, 3), (4, 3)])
def test_impossible_counts_are_refused(successes: int, runs: int) -> None:
    with pytest.raises(ValueError, match=f"{successes} successes in {runs} runs"):
        rate_interval(successes, runs)
    with pytest.raises(ValueError, match=f"{successes} successes in {runs} runs"):
        exact_interval(successes, runs)


@given(st.integers(0, 300), st.integers(0, 60), st.integers(0, 60))
def test_a_difference_turns_its_sign_with_the_versions(both: int, first: int, second: int) -> None:
    forth = difference(RatePair(both=both, only_first=first, only_second=second))
    back = difference(RatePair(both=both, only_first=second, only_second=first))
    assert forth.low == pytest.approx(-back.high)
    assert forth.low <= (second - first) / max(both + first + second, 1) <= forth.high


def test_runs_that_both_versions_end_alike_prove_that_they_hardly_differ() -> None:
    interval = difference(RatePair(both=900, neither=100))
    assert -0.01 < interval.low < 0.0 < interval.high < 0.01


def test_a_version_that_only_breaks_runs_is_worse() -> None:
    assert difference(RatePair(both=150, only_first=30)).high < 0.0

"""Intervals of a success rate: one that holds at all times, one for a fixed number of runs, one of a difference.

Sources: the interval that holds at all times is the beta-binomial mixture martingale of Robbins (1970), "Statistical
methods related to the law of the iterated logarithm", with Ville's inequality; Howard, Ramdas, McAuliffe and Sekhon
(2021), "Time-uniform, nonparametric, nonasymptotic confidence sequences", section 4. The exact one is that of Clopper
and Pearson (1934), "The use of confidence or fiducial limits illustrated in the case of the binomial".
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

from engine.sweep.statistics.special_functions import beta_quantile, log_beta, root

_PRIOR = 0.5
"""Both parameters of the mixing beta distribution (Jeffreys): it does not depend on the rate that is tested, so that
the interval holds for any of them, and it is narrowest where rates are near 0 or 1."""
_EDGE = 1e-15


class Interval(NamedTuple):
    """The rates, from 0 to 1 (of a difference from -1), that the runs do not exclude."""

    low: float
    high: float

    @property
    def width(self) -> float:
        """The distance between its ends."""
        return self.high - self.low


@dataclass(frozen=True, kw_only=True)
class RatePair:
    """How two versions ended the same runs: numbers of runs by who succeeded."""

    both: int = 0
    only_first: int = 0
    only_second: int = 0
    neither: int = 0

    @property
    def runs(self) -> int:
        """The number of runs that both versions executed."""
        return self.both + self.only_first + self.only_second + self.neither


def rate_interval(successes: int, runs: int, *, confidence: float = 0.95) -> Interval:
    """Return an interval that contains the success rate at all numbers of runs together with this confidence.

    The sweep may be looked at after every run, and ended because of what it shows: the probability that any interval
    of the whole sweep misses the rate is at most 1 - confidence. Runs are independent and equally distributed.

    Args:
        successes: Runs that succeeded.
        runs: All runs that ended.
        confidence: From 0.5 to below 1.

    Raises:
        ValueError: there are more successes than runs, or fewer than none.
    """
    _require_counts(successes, runs)
    if runs == 0:
        return Interval(0.0, 1.0)
    failures = runs - successes
    evidence = log_beta(_PRIOR + successes, _PRIOR + failures) - log_beta(_PRIOR, _PRIOR)
    threshold = -math.log1p(-confidence)

    def excess(rate: float) -> float:
        """Return the logarithm of the martingale above that at which a rate is excluded."""
        return evidence - successes * math.log(rate) - failures * math.log1p(-rate) - threshold

    middle = min(max(successes / runs, _EDGE), 1.0 - _EDGE)
    low = root(excess, _EDGE, middle) if successes else 0.0
    high = root(excess, middle, 1.0 - _EDGE) if failures else 1.0
    return Interval(low, high)


def exact_interval(successes: int, runs: int, *, confidence: float = 0.95) -> Interval:
    """Return the interval of Clopper and Pearson: for a number of runs that was fixed before, looked at once.

    Args:
        successes: Runs that succeeded.
        runs: All runs.
        confidence: From 0.5 to below 1.

    Raises:
        ValueError: there are more successes than runs, or fewer than none.
    """
    _require_counts(successes, runs)
    tail = (1.0 - confidence) / 2.0
    failures = runs - successes
    low = beta_quantile(tail, successes, failures + 1) if successes else 0.0
    high = beta_quantile(1.0 - tail, successes + 1, failures) if failures else 1.0
    return Interval(low, high)


def difference(pair: RatePair, *, confidence: float = 0.95) -> Interval:
    """Return an interval of the success rate of the second version minus that of the first, at all times.

    Both versions have executed the same configurations. Only those that ended differently count: the rate at which
    only the second succeeds minus that at which only the first does, each with half of the error.

    Args:
        pair: How they ended.
        confidence: From 0.5 to below 1.
    """
    each = 1.0 - (1.0 - confidence) / 2.0
    better = rate_interval(pair.only_second, pair.runs, confidence=each)
    worse = rate_interval(pair.only_first, pair.runs, confidence=each)
    return Interval(better.low - worse.high, better.high - worse.low)


def _require_counts(successes: int, runs: int) -> None:
    if not 0 <= successes <= runs:
        raise ValueError(f"{successes} successes in {runs} runs")

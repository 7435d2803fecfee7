"""The probability of a failure under the written distributions, estimated from the runs of a search.

Each run counts with its weight, how much more likely the written distributions draw it than the search did. Its
expected value is the probability, whatever was learned before: the mean is unbiased. Where a number of failures ends
the search, the mean leans high, and the interval still holds.

Source of the interval: I. Waudby-Smith and A. Ramdas (2024), "Estimating means of bounded random variables by betting",
section 4.3 (hedged capital); weights have bounds because a share of each batch is drawn as written.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from engine.sweep.search.search_plan import SearchStep
from engine.sweep.search.target import is_failure
from engine.sweep.statistics import Interval
from engine.sweep.statistics.special_functions import root

_FIRST_VARIANCE = 0.05
"""Of a run before any is known; what it is changes the width of the interval, not whether it holds."""
_MOST_STAKE = 0.75
_EDGE = 1e-9


@dataclass(frozen=True, kw_only=True)
class FailureProbability:
    """An estimate, and an interval that may be looked at at any time."""

    estimate: float
    interval: Interval
    effective_failures: float
    """The number of failures of equal weight that would say as much."""


def failure_probability(
    steps: Sequence[SearchStep], planned: int, *, confidence: float = 0.95
) -> FailureProbability | None:
    """Return the estimate of a search; None where its weights are unknown, or nothing has ended.

    Args:
        steps: Its runs, in the order of their numbers.
        planned: The runs that it has at most.
        confidence: Of the interval.
    """
    numbers, bounds = list[float](), list[float]()
    for step in steps:
        if step.point.weight is None:
            return None
        numbers.append(step.point.weight if is_failure(step.result) else 0.0)
        bounds.append(step.point.most_weight)
    if not numbers:
        return None
    squares = sum(number * number for number in numbers)
    return FailureProbability(
        estimate=sum(numbers) / len(numbers),
        interval=_interval(numbers, bounds, _stakes(numbers, planned, confidence), confidence),
        effective_failures=sum(numbers) ** 2 / squares if squares else 0.0,
    )


def _stakes(numbers: Sequence[float], planned: int, confidence: float) -> list[float]:
    """Return what is staked on each run: it depends on the runs before it only."""
    stakes: list[float] = []
    threshold = 2.0 * math.log(2.0 / (1.0 - confidence))
    total, squares = 0.0, _FIRST_VARIANCE
    for count, number in enumerate(numbers, start=1):
        stakes.append(math.sqrt(threshold / (planned * squares / count)))
        total += number
        squares += (number - total / (count + 1)) ** 2
    return stakes


def _interval(
    numbers: Sequence[float], bounds: Sequence[float], stakes: Sequence[float], confidence: float
) -> Interval:
    threshold = math.log(2.0 / (1.0 - confidence))

    def above(mean: float) -> float:
        """Return how much more was won with stakes on a probability above this one than excludes it."""
        won = _most(
            math.log1p(min(stake, _MOST_STAKE / mean) * (number - mean))
            for number, stake in zip(numbers, stakes, strict=True)
        )
        return won - threshold

    def below(mean: float) -> float:
        won = _most(
            math.log1p(-min(stake, _MOST_STAKE / (bound - mean)) * (number - mean))
            for number, stake, bound in zip(numbers, stakes, bounds, strict=True)
        )
        return won - threshold

    low = root(above, _EDGE, 1.0 - _EDGE) if above(_EDGE) > 0.0 > above(1.0 - _EDGE) else 0.0
    high = root(below, _EDGE, 1.0 - _EDGE) if below(_EDGE) < 0.0 < below(1.0 - _EDGE) else 1.0
    return Interval(low, high)


def _most(terms: Iterable[float]) -> float:
    """Return the largest sum of first terms, at least 0."""
    return max(itertools.accumulate(terms, initial=0.0))

"""Which factor matters: rank correlations, and success rates of the levels of a factor.

Both are simple and honest: no model is fitted. The correlation is that of Spearman; it finds effects that grow or fall
with the factor, and the rates of the levels show the others.
"""

from __future__ import annotations

import bisect
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from engine.sweep.statistics.intervals import Interval, exact_interval
from engine.sweep.statistics.special_functions import rank_correlation

_BINS = 4
"""Levels of a factor of numbers: parts with equally many runs."""
_FEW = 3


@dataclass(frozen=True, kw_only=True)
class RunGroup:
    """Runs that have something in common."""

    label: str
    runs: int
    interval: Interval
    """Of a rate, for this number of runs; where there are many groups, some intervals miss their rate."""


@dataclass(frozen=True, kw_only=True)
class Level(RunGroup):
    """The runs with one value of a factor, or with values of one range; the interval is of their success rate."""

    successes: int


@dataclass(frozen=True, kw_only=True)
class FactorEffect:
    """How the success and the duration of runs depend on a factor."""

    address: str
    with_success: float | None
    """Rank correlation from -1 to 1; None for values without an order, or where nothing varies."""
    with_duration: float | None
    """The same for the durations of runs that succeeded."""
    levels: Sequence[Level]

    @property
    def spread(self) -> float:
        """The distance between the highest and the lowest success rate of its levels."""
        rates = [level.successes / level.runs for level in self.levels if level.runs]
        return max(rates) - min(rates) if rates else 0.0


def factor_effect(
    address: str,
    values: Sequence[object],
    successes: Sequence[bool],
    durations_s: Sequence[float],
    *,
    confidence: float,
) -> FactorEffect:
    """Return the effect of one factor.

    Args:
        address: The factor.
        values: Its value in each run.
        successes: Whether each run succeeded.
        durations_s: The duration of each run.
        confidence: Of the intervals of levels.
    """
    numbers = _numbers(values)
    if numbers is None:
        levels = _levels(list(map(_label, values)), successes, confidence)
        return FactorEffect(
            address=address,
            with_success=None,
            with_duration=None,
            levels=levels,
        )
    good = [index for index, success in enumerate(successes) if success]
    return FactorEffect(
        address=address,
        with_success=correlation(numbers, [float(success) for success in successes]),
        with_duration=correlation([numbers[i] for i in good], [durations_s[i] for i in good]),
        levels=_levels(_binned(numbers), successes, confidence),
    )


def correlation(first: Sequence[float], second: Sequence[float]) -> float | None:
    """Return the rank correlation of Spearman; None where one of them does not vary, or there are fewer than three."""
    if len(first) < _FEW or len(set(first)) < 2 or len(set(second)) < 2:
        return None
    found = rank_correlation(first, second)
    return found if math.isfinite(found) else None


def quantile(ordered: Sequence[float], share: float) -> float:
    """Return the value below which this share of ordered values lies, linear between two; there is one at least."""
    place = share * (len(ordered) - 1)
    below = math.floor(place)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (place - below) * (ordered[above] - ordered[below])


def _numbers(values: Sequence[object]) -> list[float] | None:
    found = [float(value) for value in values if isinstance(value, int | float) and not isinstance(value, bool)]
    return found if found and len(found) == len(values) else None


def _binned(numbers: Sequence[float]) -> list[str]:
    """Return the level of each number: itself where there are few of them, else one of the quarters."""
    distinct = sorted(set(numbers))
    # Eight runs with a number of their own say less one by one than in quarters.
    if len(distinct) <= (2 * _BINS if len(distinct) < len(numbers) else _BINS):
        return [f"{number:g}" for number in numbers]
    ordered = sorted(numbers)
    limits = [quantile(ordered, index / _BINS) for index in range(_BINS + 1)]
    names = [f"{low:.4g} to {high:.4g}" for low, high in itertools.pairwise(limits)]
    return [names[min(bisect.bisect_right(limits[1:-1], number), _BINS - 1)] for number in numbers]


def _levels(labels: Sequence[str], successes: Sequence[bool], confidence: float) -> list[Level]:
    found: dict[str, list[bool]] = {}
    for label, success in zip(labels, successes, strict=True):
        found.setdefault(label, []).append(success)
    return [
        Level(
            label=label,
            runs=len(ends),
            successes=sum(ends),
            interval=exact_interval(sum(ends), len(ends), confidence=confidence),
        )
        for label, ends in sorted(found.items(), key=lambda item: _order(item[0]))
    ]


def _order(label: str) -> tuple[float, str]:
    try:
        return float(label.partition(" to ")[0]), label
    except ValueError:
        return math.inf, label


def _label(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)

"""The value of a factor at a probability, so that every design varies all distributions alike."""

from __future__ import annotations

import math
from statistics import NormalDist

from engine.document.sweep import Factor

_LEAST = 1e-12


def value_at(factor: Factor, share: float) -> object:
    """Return the value of a factor below which this share of its values lies (its quantile function).

    Args:
        factor: The factor.
        share: A probability from 0 to 1; at the ends of an unbounded distribution it is moved inwards by 1e-12.
    """
    if factor.values is not None:
        return factor.values[min(int(share * len(factor.values)), len(factor.values) - 1)]
    number = _number_at(factor, min(max(share, _LEAST), 1.0 - _LEAST))
    return round(number) if factor.integer else number


def levels(factor: Factor) -> tuple[object, ...]:
    """Return the values of a factor in a grid: all that are listed, or the middles of equally likely parts."""
    if factor.values is not None:
        return factor.values
    count = factor.levels
    # A distribution of integers may have fewer values than levels.
    return tuple(dict.fromkeys(value_at(factor, (index + 0.5) / count) for index in range(count)))


def share_of(factor: Factor, value: object) -> float | None:
    """Return the probability of values below this one, the inverse of `value_at`; None for a value of a list."""
    if factor.values is not None or isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if factor.normal is not None:
        return NormalDist(factor.normal.mean, factor.normal.deviation).cdf(value)
    if factor.log_uniform is not None:
        least, most = (math.log(limit) for limit in factor.log_uniform)
        return min(max((math.log(value) - least) / (most - least), 0.0), 1.0) if value > 0.0 else 0.0
    least, most = factor.uniform or (0.0, 1.0)
    return min(max((value - least) / (most - least), 0.0), 1.0)


def nominal(factor: Factor) -> object:
    """Return the value of a factor where no other is known to be nominal: its median, or the first of its values."""
    return factor.values[0] if factor.values is not None else value_at(factor, 0.5)


def _number_at(factor: Factor, share: float) -> float:
    if factor.normal is not None:
        return NormalDist(factor.normal.mean, factor.normal.deviation).inv_cdf(share)
    if factor.log_uniform is not None:
        least, most = (math.log(limit) for limit in factor.log_uniform)
        return math.exp(least + share * (most - least))
    least, most = factor.uniform or (0.0, 1.0)
    # An integer has an equal share of the range, so that the ends are as likely as the rest.
    if factor.integer:
        return min(math.floor(least + share * (most - least + 1.0)), most)
    return least + share * (most - least)

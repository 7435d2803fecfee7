"""The compiled core of timing: the time-optimal rates of a path by reachability analysis (TOPP-RA), and its times.

Along a path q(s) the joints' accelerations are q' u + q'' x, with x the squared rate and u half its
derivative. After Pham and Pham, "A New Approach to Time-Optimal Path Parameterization Based on
Reachability Analysis" (2018); the linear programs have one unknown each, as x is found by bisection.
"""

from __future__ import annotations

import math

from robots.compiled import compiled
from robots.port import Array

_MATRIX = "f8[:,::1]"


@compiled()
def _range(first: Array, second: Array, i: int, x: float, step: float, most: Array) -> tuple[float, float]:
    """Return the least and the greatest u that the acceleration limits allow from point i, with this x, to the next.

    The limits apply at both points: with the first alone, a curve would be entered too fast.
    """
    low, high = -1e12, 1e12
    for j in range(first.shape[1]):
        for end in range(2):
            rest = second[i + end, j] * x
            slope = first[i + end, j] + 2.0 * step * end * second[i + end, j]
            if abs(slope) < 1e-9:
                if abs(rest) > most[j]:
                    return 1.0, -1.0
                continue
            a, b = (-most[j] - rest) / slope, (most[j] - rest) / slope
            low, high = max(low, min(a, b)), min(high, max(a, b))
    return low, high


@compiled()
def _can_follow(first: Array, second: Array, i: int, x: float, step: float, later: float, most: Array) -> bool:
    """Return whether some u leads from this x at point i to between 0 and `later` at the next point."""
    low, high = _range(first, second, i, x, step, most)
    low, high = max(low, -x / (2.0 * step)), min(high, (later - x) / (2.0 * step))
    return low <= high + 1e-12


@compiled(f"f8[::1]({_MATRIX}, {_MATRIX}, f8[::1], f8[::1], f8[::1], f8[::1])")
def passing_rates(first: Array, second: Array, along: Array, fastest: Array, most: Array, top: Array) -> Array:
    """Return x, the squared rate, at each point of a path: the fastest allowed, at rest at both ends.

    `first` and `second` (k, n) are the derivatives of the path at the points `along` (k,), `fastest` and
    `most` (n,) the limits of the joints' speeds and accelerations. `top` (k,), an upper bound of x, is overwritten.
    """
    count = len(along)
    for i in range(count):
        for j in range(first.shape[1]):
            slope = abs(first[i, j])
            if slope > 1e-9:
                top[i] = min(top[i], (fastest[j] / slope) ** 2)
    top[count - 1] = 0.0
    for i in range(count - 2, -1, -1):
        step = along[i + 1] - along[i]
        low, high = 0.0, top[i]
        if not _can_follow(first, second, i, high, step, top[i + 1], most):
            for _ in range(50):
                middle = 0.5 * (low + high)
                if _can_follow(first, second, i, middle, step, top[i + 1], most):
                    low = middle
                else:
                    high = middle
            top[i] = low
    x = top.copy()
    x[0] = 0.0
    for i in range(count - 1):
        step = along[i + 1] - along[i]
        _, high = _range(first, second, i, x[i], step, most)
        x[i + 1] = max(0.0, min(top[i + 1], x[i] + 2.0 * step * high))
    return x


@compiled("f8[::1](f8[::1], f8[::1])")
def passing_times(along: Array, x: Array) -> Array:
    """Return the time of each point, with x linear between points; infinite from two successive points of rate 0."""
    times = along.copy()
    times[0] = 0.0
    for i in range(1, len(along)):
        rates = math.sqrt(x[i]) + math.sqrt(x[i - 1])
        times[i] = times[i - 1] + (2.0 * (along[i] - along[i - 1]) / rates if rates > 0.0 else math.inf)
    return times

"""Corrects an integrated path to start at the arm's position at rest and to end at its goal at rest.

A primitive starts at its `y0` with `dy0` and approaches its goal asymptotically. The error at either
end is added as a quintic that fades within a share of the duration, so the path in between is that
of the primitive.
"""

from __future__ import annotations

import numpy as np

from robots.port import Array

START_SHARE, END_SHARE = 0.4, 0.25
"""Share of tau within which the correction fades out at the start, and fades in at the end."""

ENDS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 8.0)
"""Shares of tau at which a path may end; it ends at the first one with a negligible error."""


def is_negligible(value: Array, rate: Array, push: Array, *, a_z: float, least: float) -> bool:
    """Return whether an end with error `value`, `rate` and `push` counts as at rest, within `least`."""
    pole = a_z / 2.0
    return max(_longest(value), _longest(rate) / pole, _longest(push) / pole**2) <= least


def fade(shares: Array, width: float, *, value: Array, rate: Array, push: Array | None = None) -> tuple[Array, Array]:
    """Return a function and its rate that start with `value`, `rate` and `push`, each (n,), and are 0 from `width` on.

    Both are (T, n) at the shares (T,), which start at 0.
    """
    u = np.minimum(shares / width, 1.0)[:, None]
    u2, u3, u4 = u * u, u**3, u**4
    slope, bend = rate * width, (np.zeros_like(value) if push is None else push * width**2)
    values = (
        value * (1.0 - 10.0 * u3 + 15.0 * u4 - 6.0 * u4 * u)
        + slope * (u - 6.0 * u3 + 8.0 * u4 - 3.0 * u4 * u)
        + bend * (0.5 * u2 - 1.5 * u3 + 1.5 * u4 - 0.5 * u4 * u)
    )
    rates = (
        value * (-30.0 * u2 + 60.0 * u3 - 30.0 * u4)
        + slope * (1.0 - 18.0 * u2 + 32.0 * u3 - 15.0 * u4)
        + bend * (u - 4.5 * u2 + 6.0 * u3 - 2.5 * u4)
    )
    return values, rates / width


def fade_in(shares: Array, width: float, *, value: Array, rate: Array, push: Array) -> tuple[Array, Array]:
    """Return a function, and its rate, that is 0 until `width` before the last share and ends with the given values."""
    values, rates = fade((shares[-1] - shares)[::-1], width, value=value, rate=-rate, push=push)
    return values[::-1], -rates[::-1]


def _longest(vector: Array) -> float:
    return float(np.abs(vector).max())

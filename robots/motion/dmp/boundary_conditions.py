"""Brings a rolled out path to start where the arm stands at rest and to end at its goal at rest.

A primitive starts at its `y0` with `dy0` and approaches its goal for ever. What is missing at either
end is added as a quintic that fades within a share of the duration, so the path in between is the
primitive's own.
"""

from __future__ import annotations

import numpy as np

from robots.port import Array

START_SHARE, END_SHARE = 0.4, 0.25
"""Within which share of tau what is missing at the start fades, and at the end comes in."""

ENDS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 8.0)
"""After which shares of tau a path may end; it does at the first where hardly anything is missing."""


def is_negligible(value: Array, rate: Array, push: Array, *, a_z: float, least: float) -> bool:
    """Tell whether an end that lacks `value` and still has `rate` and `push` is as good as at rest, within `least`."""
    pole = a_z / 2.0
    return max(_longest(value), _longest(rate) / pole, _longest(push) / pole**2) <= least


def fade(shares: Array, width: float, *, value: Array, rate: Array, push: Array | None = None) -> tuple[Array, Array]:
    """Return what begins with `value`, `rate` and `push`, each (n,), and is nothing from `width` on: it and its rate.

    Both are (T, n) at the shares (T,), which count from 0.
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
    """Return what is nothing until `width` before the last share and ends with `value`, `rate` and `push`."""
    values, rates = fade((shares[-1] - shares)[::-1], width, value=value, rate=-rate, push=push)
    return values[::-1], -rates[::-1]


def _longest(vector: Array) -> float:
    return float(np.abs(vector).max())

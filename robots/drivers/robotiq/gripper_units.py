"""Metres, metres per second and newton at the edge of the driver; counts from 0 to 255 behind it."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise

MIN_SPEED_M_S, MAX_SPEED_M_S = 0.020, 0.150
MIN_FORCE_N, MAX_FORCE_N = 20.0, 235.0
OPEN_COUNT, CLOSED_COUNT = 0, 255

WidthTable = Sequence[tuple[int, float]]
"""Measured counts and the opening between the pads at each, metres; counts rise, openings fall."""


def width_of_count(count: int, table: WidthTable) -> float:
    """Return the opening at a measured count, interpolated; constant beyond both ends of the table."""
    counts = [entry[0] for entry in table]
    upper = min(max(1, bisect_right(counts, count)), len(table) - 1)
    (low, low_m), (high, high_m) = table[upper - 1], table[upper]
    share = min(1.0, max(0.0, (count - low) / (high - low)))
    return low_m + share * (high_m - low_m)


def count_of_width(width_m: float, table: WidthTable) -> int:
    """Return the position request for an opening; the whole range of requests where it is fully open or closed."""
    if width_m >= table[0][1]:
        return OPEN_COUNT
    if width_m <= table[-1][1]:
        return CLOSED_COUNT
    for (low, low_m), (high, high_m) in pairwise(table):
        if low_m >= width_m >= high_m:
            return round(low + (low_m - width_m) / (low_m - high_m) * (high - low))
    raise ValueError(f"the openings of the table do not fall: {table}")


def speed_count(speed_m_s: float) -> int:
    """Return rSP, clipped to what the gripper can do."""
    return _byte((speed_m_s - MIN_SPEED_M_S) / (MAX_SPEED_M_S - MIN_SPEED_M_S))


def force_count(force_n: float) -> int:
    """Return rFR, clipped to what the gripper can do."""
    return _byte((force_n - MIN_FORCE_N) / (MAX_FORCE_N - MIN_FORCE_N))


def speed_of_count(count: int) -> float:
    """Return the speed of rSP."""
    return MIN_SPEED_M_S + count / 255.0 * (MAX_SPEED_M_S - MIN_SPEED_M_S)


def force_of_count(count: int) -> float:
    """Return the force of rFR."""
    return MIN_FORCE_N + count / 255.0 * (MAX_FORCE_N - MIN_FORCE_N)


def _byte(share: float) -> int:
    return round(255.0 * min(1.0, max(0.0, share)))

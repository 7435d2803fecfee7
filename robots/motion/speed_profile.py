"""Speed along a path: how much of it is completed when, from rest to rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from robots.motion.min_jerk import PEAK_SPEED, min_jerk
from robots.port import Array

# A change of speed follows minimum jerk, within this acceleration, and takes at least this time.
_ACCELERATION_M_S2, _SHORTEST_BLEND_S = 0.5, 0.1
_HALVINGS = 40


@dataclass(frozen=True, kw_only=True)
class SpeedProfile:
    """`shares` maps shares of the time, 0 to 1, to completed shares of the path.

    `peak` is the peak speed as a multiple of the mean speed.
    """

    shares: Callable[[Array], Array]
    peak: float


MIN_JERK = SpeedProfile(shares=min_jerk, peak=PEAK_SPEED)
"""The smoothest profile."""


def plan_approach(
    distance_m: float, *, clear_m: float, speed_m_s: float, touch_m_s: float
) -> tuple[SpeedProfile, float]:
    """Return a profile and its time, s: at most `speed_m_s` in the first `clear_m`, then at most `touch_m_s`."""
    blend_s = _blend_s(touch_m_s)
    if touch_m_s * blend_s > distance_m:
        return MIN_JERK, PEAK_SPEED * distance_m / touch_m_s
    top = _top_speed(clear_m, speed_m_s, touch_m_s)
    slowing_s = _blend_s(top - touch_m_s) if top > touch_m_s else 0.0
    ramp_s = _blend_s(top)
    ramps_m = (top * ramp_s + (top + touch_m_s) * slowing_s) / 2.0
    cruise_s = max(0.0, clear_m - ramps_m) / top if slowing_s else 0.0
    rest_m = distance_m - ramps_m - cruise_s * top - touch_m_s * blend_s / 2.0
    times = np.cumsum((0.0, ramp_s, cruise_s, slowing_s, rest_m / touch_m_s, blend_s))
    speeds = np.array((0.0, top, top, touch_m_s, touch_m_s, 0.0))
    duration_s = float(times[-1])

    def shares(time_shares: Array) -> Array:
        return integrate_speeds(np.clip(time_shares, 0.0, 1.0) * duration_s, times, speeds)[0] / distance_m

    return SpeedProfile(shares=shares, peak=top * duration_s / distance_m), duration_s


def _blend_s(change_m_s: float) -> float:
    return max(_SHORTEST_BLEND_S, PEAK_SPEED * change_m_s / _ACCELERATION_M_S2)


def _top_speed(clear_m: float, speed_m_s: float, touch_m_s: float) -> float:
    """Return the greatest speed from which the touch speed is reached within `clear_m`."""

    def needed_m(top: float) -> float:
        return (top * _blend_s(top) + (top + touch_m_s) * _blend_s(top - touch_m_s)) / 2.0

    low, high = touch_m_s, max(speed_m_s, touch_m_s)
    if needed_m(low) > clear_m:
        return touch_m_s
    if needed_m(high) <= clear_m:
        return high
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if needed_m(middle) <= clear_m else (low, middle)
    return low


def integrate_speeds(passed_s: Array, times: Array, speeds: Array) -> tuple[Array, Array]:
    """Return distances and speeds at instants, for speeds that change with minimum jerk between those at `times`."""
    lengths = np.diff(times)
    starts = np.concatenate(([0.0], np.cumsum(lengths * (speeds[:-1] + speeds[1:]) / 2.0)))
    index = np.clip(np.searchsorted(times, passed_s, side="right") - 1, 0, len(lengths) - 1)
    length = lengths[index]
    u = np.divide(passed_s - times[index], length, out=np.zeros_like(passed_s), where=length > 0.0)
    change = speeds[index + 1] - speeds[index]
    distances = starts[index] + length * (speeds[index] * u + change * u**4 * (2.5 - 3.0 * u + u**2))
    return distances, speeds[index] + change * min_jerk(u)

"""Minimum jerk: the smoothest profile from 0 to 1, at rest at both ends (quintic)."""

from __future__ import annotations

import numpy as np

from robots.port import Array

PEAK_SPEED = 1.875
"""Peak speed of the profile, as a multiple of the mean speed."""
PEAK_ACCELERATION = 10.0 / 3.0**0.5
"""Peak acceleration of the profile, as a multiple of distance / time²."""


def min_jerk(share: Array) -> Array:
    """Return the completed share of the path after `share` (0 to 1, any shape) of the time."""
    t = np.clip(share, 0.0, 1.0)
    return t**3 * (10.0 - 15.0 * t + 6.0 * t**2)

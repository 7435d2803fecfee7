"""Duration of a straight minimum-jerk motion for a given maximum speed."""

from __future__ import annotations

import math

from engine.messages import Pose

PEAK_TO_MEAN = 15 / 8
"""Ratio of maximum to mean speed of a minimum-jerk motion."""
TURN_RAD_S = 1.0
"""Maximum angular speed; it limits the motion if the rotation takes longer than the translation."""
SHORTEST_S = 0.1


def line_duration_s(start: Pose, end: Pose, *, speed_m_s: float) -> float:
    """Return the travel time between two poses of one frame, limited by `speed_m_s` and `TURN_RAD_S`."""
    translation_s = math.dist(start.xyz, end.xyz) * PEAK_TO_MEAN / speed_m_s
    rotation_s = _angle_rad(start, end) * PEAK_TO_MEAN / TURN_RAD_S
    return max(translation_s, rotation_s, SHORTEST_S)


def _angle_rad(start: Pose, end: Pose) -> float:
    product = abs(sum(a * b for a, b in zip(start.xyzw, end.xyzw, strict=True)))
    return 2 * math.acos(min(1.0, product))

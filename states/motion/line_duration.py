"""How long a straight minimum-jerk motion takes when its greatest speed is given."""

from __future__ import annotations

import math

from engine.messages import Pose

PEAK_TO_MEAN = 15 / 8
"""Greatest over mean speed of a minimum-jerk motion."""
TURN_RAD_S = 1.0
"""Greatest turning speed, where turning takes longer than the way."""
SHORTEST_S = 0.1


def line_duration_s(start: Pose, end: Pose, *, speed_m_s: float) -> float:
    """Return the travel time between two poses of one frame, at most `speed_m_s` and `TURN_RAD_S` fast."""
    way_s = math.dist(start.xyz, end.xyz) * PEAK_TO_MEAN / speed_m_s
    turn_s = _angle_rad(start, end) * PEAK_TO_MEAN / TURN_RAD_S
    return max(way_s, turn_s, SHORTEST_S)


def _angle_rad(start: Pose, end: Pose) -> float:
    product = abs(sum(a * b for a, b in zip(start.xyzw, end.xyzw, strict=True)))
    return 2 * math.acos(min(1.0, product))

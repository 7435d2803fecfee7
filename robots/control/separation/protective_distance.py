"""The protective separation distance of ISO/TS 15066, 5.5.4, and the stops of an arm that it depends on."""

from __future__ import annotations

import numpy as np

from robots.model.robot_model import JointLimits
from robots.port import Array, SeparationRule

# As in `TrajectoryPlayback`: shares of the limits that a stop uses, share of the jerk with which it fades, shortest
# stop from the nominal pace.
_ACCELERATION_SHARE, _JERK_SHARE, _FADING_SHARE = 0.9, 0.85, 0.5
_SHORTEST_STOP_S = 0.1
# A path may take acceleration and jerk for itself while the arm stops on it.
_ON_PATH = 1.35
# The time constant of the drives that follow the set point.
_FOLLOWING_S = 0.02


class StopModel:
    """Times and lengths of stops of one arm, from the limits of its joints."""

    def __init__(self, limits: JointLimits) -> None:
        self._acceleration = np.array(limits.acceleration_rad_s2) * _ACCELERATION_SHARE
        self._jerk = np.array(limits.jerk_rad_s3) * _JERK_SHARE

    def time_s(self, speeds_rad_s: Array, shares: Array) -> Array:
        """Return the times (k,) of stops from the shares (k,) of joint speeds (n,); 0 from rest."""
        speed = np.abs(speeds_rad_s)[None, :] * shares[:, None]
        acceleration, jerk = self._acceleration, self._jerk
        # The deceleration rises with the jerk limit and fades with a share of it.
        ramps = 1.0 / jerk + 1.0 / (_FADING_SHARE * jerk)
        lost = acceleration**2 * ramps / 2.0
        full = speed / acceleration + acceleration * ramps / 2.0
        short = np.sqrt(2.0 * speed * ramps)
        slowest = np.where(speed >= lost, full, short).max(axis=1)
        times = np.maximum(slowest, _SHORTEST_STOP_S * shares) * _ON_PATH
        return np.where(shares > 0.0, times + _FOLLOWING_S, 0.0)


def protective_distance_m(
    rule: SeparationRule, *, reaction_s: float, speed_m_s: Array, stop_s: Array, stop_m: Array
) -> Array:
    """Return S_p = v_h (T_r + T_s) + v_r T_r + S_s + C + Z_d + Z_r for each speed of an arm.

    `speed_m_s` is that of its fastest point, v_r; `stop_s` and `stop_m` are T_s and S_s from that speed; `reaction_s`
    is T_r.
    """
    moved_m = rule.hand_speed_m_s * (reaction_s + stop_s)
    return moved_m + speed_m_s * reaction_s + stop_m + rule.intrusion_m + rule.uncertainty_m

"""Speed and separation monitoring of one arm: the share of speed that its measured distance from people permits."""

from __future__ import annotations

import math

import numpy as np

from robots.control.generators.motion_generator import MotionGenerator
from robots.control.separation.motion_speed import MotionSpeed
from robots.control.separation.protective_distance import StopModel, protective_distance_m
from robots.model.mechanics.kinematics import ArmKinematics
from robots.port import Array, MeasuredSeparation, PermittedSpeed, SeparationRule

_SHARES = np.linspace(0.0, 1.0, 51)
# Part of v T by which a stop of the duration T from the speed v moves at most: half, as its deceleration fades longer
# than it rises, and what a bent path adds.
STOP_SHARE = 0.6
# A slower motion than that stands still, and one that stands still starts from more.
_LEAST_SHARE, _STARTING_SHARE = 0.02, 0.05
# The permitted share rises by that per second: measured distances vary with the voxels.
_RISE_PER_S = 0.8


class SeparationMonitor:
    """Owned by one control loop, which asks for `permitted_share` once per period.

    Without a measurement, or with one that grows old, the permitted speed falls to 0.

    Args:
        rule: The constants of the cell.
        kinematics: An instance of its own.
    """

    def __init__(self, rule: SeparationRule, *, kinematics: ArmKinematics) -> None:
        self._rule = rule
        self._kinematics = kinematics
        self._stops = StopModel(kinematics.limits)
        self._measured: MeasuredSeparation | None = None
        self._since_s = 0.0
        self._speed: MotionSpeed | None = None
        self._table: tuple[Array, Array, Array] | None = None
        self._share = 0.0
        self._has_moved = False
        self._permitted_after_s: float = math.nan
        """The reaction time for which `permitted` was computed from the measurement, not a number for none."""
        self.permitted = PermittedSpeed(share=0.0, speed_m_s=0.0)
        """What is permitted now."""

    def take(self, measured: MeasuredSeparation) -> None:
        """Take a measurement."""
        if self._measured is None or measured.extents_m != self._measured.extents_m:
            self._table = None
        self._measured, self._since_s, self._permitted_after_s = measured, 0.0, math.nan

    def forget(self) -> None:
        """Drop the measurement and the motion: the world was restored to another state."""
        self._measured, self._speed, self._table, self._share = None, None, None, 0.0

    def permitted_share(self, step_s: float, generator: MotionGenerator | None) -> float:
        """Return the permitted share, 0 to 1, of the full pace of a motion."""
        self._since_s += step_s
        if generator is None:
            self._speed, self._table, self._share = None, None, 0.0
            return 0.0
        if not generator.leads:
            # Whoever guides the arm touches it.
            return 1.0
        if self._speed is None or self._speed.generator is not generator:
            self._speed = MotionSpeed(generator, kinematics=self._kinematics)
            self._table, self._share, self._has_moved = None, 0.0, False
        if not self._speed.known:
            self._speed.look()
            return 0.0
        share = self._permitted_now()
        if share < (_LEAST_SHARE if self._share > 0.0 else _STARTING_SHARE):
            share = 0.0
        # A motion that has not moved yet may start with any share.
        self._share = min(share, self._share + _RISE_PER_S * step_s) if self._has_moved else share
        self._has_moved = self._has_moved or share > 0.0
        return self._share

    def _permitted_now(self) -> float:
        measured, rule = self._measured, self._rule
        if measured is None:
            self.permitted = PermittedSpeed(share=0.0, speed_m_s=0.0)
            return 0.0
        reaction_s = max(rule.reaction_s, measured.age_s + self._since_s + rule.delay_s)
        if self._table is None:
            self._table, self._permitted_after_s = self._new_table(measured), math.nan
        elif reaction_s == self._permitted_after_s:
            return self.permitted.share
        speed_m_s, stop_s, stop_m = self._table
        required_m = protective_distance_m(
            rule, reaction_s=reaction_s, speed_m_s=speed_m_s, stop_s=stop_s, stop_m=stop_m
        )
        if math.isinf(measured.distance_m):
            # Nobody is measured, so only the age counts: at twice the regular one the arm stands.
            share = min(1.0, max(0.0, 2.0 - reaction_s / rule.reaction_s))
        elif measured.distance_m <= required_m[0]:
            share = 0.0
        else:
            share = float(np.interp(measured.distance_m, required_m, _SHARES))
        self.permitted = PermittedSpeed(
            share=share, speed_m_s=share * float(speed_m_s[-1]), protective_m=float(required_m[-1])
        )
        self._permitted_after_s = reaction_s
        return share

    def _new_table(self, measured: MeasuredSeparation) -> tuple[Array, Array, Array]:
        """Return speeds, stop times and stop lengths for all shares of the full pace."""
        assert self._speed is not None
        speed_m_s = self._speed.fastest_m_s(measured.extents_m) * _SHARES
        stop_s = self._stops.time_s(self._speed.joints_rad_s, _SHARES)
        return speed_m_s, stop_s, STOP_SHARE * speed_m_s * stop_s

"""Gravity compensation: the arm floats and can be guided by hand (RCL 4.1.2)."""

from __future__ import annotations

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState
from robots.control.laws.controller import SetPoint
from robots.control.laws.joint_impedance import nominal_stiffness_nm_rad
from robots.model.robot_model import JointLimits
from robots.port import Array

# Beyond this share of its speed limit a joint is fully damped, so that it can always stop in time.
_FREE_SPEED_SHARE = 0.5


class GravityCompensation:
    """Implements `Controller` for motions whose set point follows the arm, see `GuidingGenerator`.

    Where the set point equals the measured joints, τ is the feedforward minus `damping_share` of the
    critical damping; above half the speed limit full damping acts. Where the set point
    stays behind, as at the joint limits, the nominal spring with full damping pushes back.
    """

    def __init__(self, limits: JointLimits) -> None:
        self._stiffness = nominal_stiffness_nm_rad(limits)
        self._limit_nm = np.array(limits.effort_nm)
        self._free_rad_s = _FREE_SPEED_SHARE * np.array(limits.velocity_rad_s)
        self._damping = np.zeros_like(self._stiffness)
        self.damping_share = 0.0

    def initialize(self, *, settings: ControlSettings, inertia_kg_m2: Array) -> None:
        """Take the critical damping of the nominal stiffness for this inertia, (n,)."""
        self._damping = 2.0 * np.sqrt(self._stiffness * inertia_kg_m2)

    def step(self, state: ArmState, set_point: SetPoint, *, feedforward_nm: Array) -> Array:
        """Return the joint torques, within the limits."""
        behind = set_point.position - state.position
        velocity = state.velocity
        free = np.minimum(np.maximum(velocity, -self._free_rad_s), self._free_rad_s)
        share = np.where(behind == 0.0, self.damping_share, 1.0)
        braking = self._damping * (share * free + (velocity - free))
        torque = self._stiffness * behind - braking + feedforward_nm
        return np.minimum(np.maximum(torque, -self._limit_nm), self._limit_nm)

    def terminate(self) -> Array:
        """Return the final torques: zero."""
        return np.zeros_like(self._limit_nm)

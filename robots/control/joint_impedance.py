"""Joint impedance: springs and dampers towards a set point, on top of the arm's own dynamics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.model.robot_model import JointLimits
from robots.port import Array

# A joint answers this much error with its whole torque; 87 N m make 1450 N m/rad.
_FULL_TORQUE_ERROR_RAD = 0.06


@dataclass(frozen=True, kw_only=True)
class ImpedanceGains:
    """Stiffness in N m/rad and damping ratio (1 is critical) per joint, shapes (n,)."""

    stiffness_nm_rad: Array
    damping_ratio: Array

    @classmethod
    def for_limits(cls, limits: JointLimits) -> ImpedanceGains:
        """Return gains in proportion to each joint's torque limit, critically damped."""
        effort = np.array(limits.effort_nm)
        return cls(stiffness_nm_rad=effort / _FULL_TORQUE_ERROR_RAD, damping_ratio=np.ones_like(effort))


class JointImpedance:
    """τ = clip(K (q_d − q) + D (q̇_d − q̇) + feedforward), D critical for the inertia given at the start.

    Call `initialize` once, `step` at every control period, `terminate` at the end. The feedforward
    (gravity, Coriolis, and inertia along the set point) comes from the arm's own model, never from
    what it carries: a payload shows as an error of load / stiffness.
    """

    def __init__(self, *, gains: ImpedanceGains, effort_nm: Array) -> None:
        self._gains = gains
        self._upper_nm = effort_nm.copy()
        self._lower_nm = -effort_nm
        self._damping = np.zeros_like(effort_nm)
        self._torque = np.zeros_like(effort_nm)
        self._work = np.zeros_like(effort_nm)

    def initialize(self, *, inertia_kg_m2: Array) -> None:
        """Set the damping for the joints' own inertia (diagonal of the mass matrix), shape (n,)."""
        self._damping = 2.0 * self._gains.damping_ratio * np.sqrt(self._gains.stiffness_nm_rad * inertia_kg_m2)
        self._torque[:] = 0.0

    def step(
        self, *, position: Array, velocity: Array, desired: Array, desired_velocity: Array, feedforward_nm: Array
    ) -> Array:
        """Return the joint torques, within the limits; the array is reused by the next call."""
        torque, work = self._torque, self._work
        np.subtract(desired, position, out=torque)
        torque *= self._gains.stiffness_nm_rad
        np.subtract(desired_velocity, velocity, out=work)
        work *= self._damping
        torque += work
        torque += feedforward_nm
        np.minimum(torque, self._upper_nm, out=torque)
        np.maximum(torque, self._lower_nm, out=torque)
        return torque

    def terminate(self) -> Array:
        """Return the torques to leave behind: none."""
        self._torque[:] = 0.0
        return self._torque

"""Joint impedance: springs and dampers towards a set point, added to the arm's dynamics (RCY 4.4, eq. 1)."""

from __future__ import annotations

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState
from robots.control.laws.controller import SetPoint
from robots.model.robot_model import JointLimits
from robots.port import Array

# A joint applies its full torque at this error; 87 N m give 1450 N m/rad.
_FULL_TORQUE_ERROR_RAD = 0.06


def nominal_stiffness_nm_rad(limits: JointLimits) -> Array:
    """Return the default joint stiffness, proportional to each torque limit, (n,)."""
    return np.array(limits.effort_nm) / _FULL_TORQUE_ERROR_RAD


class JointImpedance:
    """Implements `Controller`: τ = clip(K (q_d − q) + D (q̇_d − q̇) + feedforward).

    D is `joint_damping_ratio` times critical for the inertia given at the start. Load
    beyond `load_kg` is not in the feedforward: it causes an error of load / stiffness.
    """

    def __init__(self, limits: JointLimits) -> None:
        self._nominal = nominal_stiffness_nm_rad(limits)
        self._upper_nm = np.array(limits.effort_nm)
        self._lower_nm = -self._upper_nm
        self._stiffness = self._nominal
        self._damping = np.zeros_like(self._nominal)
        self._torque = np.zeros_like(self._nominal)
        self._work = np.zeros_like(self._nominal)

    def initialize(self, *, settings: ControlSettings, inertia_kg_m2: Array) -> None:
        """Take stiffness and damping ratio; the damping is for the joints' own inertia, (n,)."""
        given = settings.joint_stiffness_nm_rad
        self._stiffness = np.array(given) if given else self._nominal
        self._damping = 2.0 * settings.joint_damping_ratio * np.sqrt(self._stiffness * inertia_kg_m2)
        self._torque[:] = 0.0

    def step(self, state: ArmState, set_point: SetPoint, *, feedforward_nm: Array) -> Array:
        """Return the joint torques, within the limits; the array is reused by the next call."""
        torque, work = self._torque, self._work
        np.subtract(set_point.position, state.position, out=torque)
        torque *= self._stiffness
        np.subtract(set_point.velocity, state.velocity, out=work)
        work *= self._damping
        torque += work
        torque += feedforward_nm
        np.minimum(torque, self._upper_nm, out=torque)
        np.maximum(torque, self._lower_nm, out=torque)
        return torque

    def terminate(self) -> Array:
        """Return the final torques: zero."""
        self._torque[:] = 0.0
        return self._torque

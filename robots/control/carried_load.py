"""What an arm is told that it carries: the torques that bear it, and its part in what is felt."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.model.kinematics import ArmKinematics
from robots.model.transform import RigidTransform, cross
from robots.port import ArmSettings, Array

_UPRIGHT = (0.0, 0.0, 0.0, 1.0)


class CarriedLoad:
    """A mass at a point of the tool link; its rotational inertia is neglected.

    `measure` once per control period, then `bearing_nm`, `felt_nm` and `felt_at` are of that period.

    Args:
        kinematics: Of the arm, at any tool centre point.
        gravity_m_s2: Gravity in the world, (3,).
    """

    def __init__(self, kinematics: ArmKinematics, *, gravity_m_s2: Array) -> None:
        self._kinematics = kinematics
        self._gravity = gravity_m_s2
        self._at = kinematics
        self._mass_kg = 0.0
        self._jacobian = np.zeros((3, kinematics.dof))
        self._xyz = np.zeros(3)
        self._velocity: Array | None = None
        self._force = np.zeros(3)

    @property
    def none(self) -> bool:
        """True while nothing is carried."""
        return self._mass_kg == 0.0

    def take(self, settings: ArmSettings) -> None:
        """Carry the load of `settings` from now on."""
        self._mass_kg = settings.load_kg
        self._at = self._kinematics.with_tool(RigidTransform.of(settings.load_com_m, _UPRIGHT))
        self._velocity = None

    def forget_motion(self) -> None:
        """Take no acceleration from what was measured before: the arm is somewhere else."""
        self._velocity = None

    def measure(self, state: ArmState, step_s: float) -> None:
        """Take the joints of a new control period; the acceleration is the change of velocity since the last."""
        pose, jacobian = self._at.tool_pose_and_jacobian(state.position)
        self._xyz, self._jacobian = pose.xyz, jacobian[:3]
        velocity = self._jacobian @ state.velocity
        before = velocity if self._velocity is None else self._velocity
        self._force = self._mass_kg * (self._gravity - (velocity - before) / step_s)
        self._velocity = velocity

    def bearing_nm(self, acceleration: Array) -> Array:
        """Return the joint torques that hold the load up and accelerate it along the set point, (n,)."""
        force = self._mass_kg * (self._jacobian @ acceleration - self._gravity)
        return force @ self._jacobian

    def felt_nm(self) -> Array:
        """Return the joint torques by which the load pulls at the arm, (n,)."""
        return self._force @ self._jacobian

    def felt_at(self, point: Array) -> Array:
        """Return force and torque of the load about a point of the world, (6,)."""
        return np.concatenate((self._force, cross(self._xyz - point, self._force)))

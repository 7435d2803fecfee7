"""The configured load of an arm: its compensation torques and its share of the measured forces."""

from __future__ import annotations

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform, cross
from robots.port import Array

_UPRIGHT = (0.0, 0.0, 0.0, 1.0)
# Less than this may be friction or noise.
_NOTICED_KG = 0.2
# Share of a pull that may be sideways for it to count as a weight.
_SIDEWAYS = 0.2


class CarriedLoad:
    """A point mass on the tool link; its rotational inertia is neglected.

    Call `measure` once per control period; `bearing_nm`, `felt_nm` and `felt_at` refer to that period.

    Args:
        kinematics: Kinematics of the arm, with any tool centre point.
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
        """True without a load."""
        return self._mass_kg == 0.0

    def take(self, settings: ControlSettings) -> None:
        """Apply the load of `settings`."""
        self._mass_kg = settings.load_kg
        self._at = self._kinematics.with_tool(RigidTransform.of(settings.load_com_m, _UPRIGHT))
        self._velocity = None

    def forget_motion(self) -> None:
        """Reset the velocity history: the arm was moved elsewhere."""
        self._velocity = None

    def measure(self, state: ArmState, step_s: float) -> None:
        """Take the joints of a new control period; the acceleration is the change of velocity since the last one."""
        pose, jacobian = self._at.tool_pose_and_jacobian(state.position)
        self._xyz, self._jacobian = pose.xyz, jacobian[:3]
        velocity = self._jacobian @ state.velocity
        before = velocity if self._velocity is None else self._velocity
        self._force = self._mass_kg * (self._gravity - (velocity - before) / step_s)
        self._velocity = velocity

    def unknown_kg(self, force_n: Array) -> float:
        """Return the mass whose weight a force on the tool is, beyond the configured load; 0 for any other force.

        Args:
            force_n: External force on the tool without that of the load, world axes, (3,).
        """
        gravity_m_s2 = float(np.linalg.norm(self._gravity))
        if gravity_m_s2 == 0.0:
            return 0.0
        down = self._gravity / gravity_m_s2
        weight_n = float(force_n @ down)
        if weight_n < _NOTICED_KG * gravity_m_s2 or np.linalg.norm(force_n - weight_n * down) > _SIDEWAYS * weight_n:
            return 0.0
        return weight_n / gravity_m_s2

    def bearing_nm(self, acceleration: Array) -> Array:
        """Return the joint torques that support the load and accelerate it along the set point, (n,)."""
        force = self._mass_kg * (self._jacobian @ acceleration - self._gravity)
        return force @ self._jacobian

    def felt_nm(self) -> Array:
        """Return the joint torques that the load exerts on the arm, (n,)."""
        return self._force @ self._jacobian

    def felt_at(self, point: Array) -> Array:
        """Return force and torque of the load about a point in the world, (6,)."""
        return np.concatenate((self._force, cross(self._xyz - point, self._force)))

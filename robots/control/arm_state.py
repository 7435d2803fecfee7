"""The state of one arm in a control loop at one instant: joints, tool and external forces."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from robots.model.transform import RigidTransform
from robots.port import Array


class ToolKinematics(Protocol):
    """The kinematics a control loop needs; `robots.model.mechanics.kinematics.ArmKinematics` implements it."""

    @property
    def dof(self) -> int:
        """Number of joints n."""
        ...

    def tool_pose(self, joints: Array) -> RigidTransform:
        """Pose of the tool centre point in the world for joints of shape (n,)."""
        ...

    def tool_pose_and_jacobian(self, joints: Array) -> tuple[RigidTransform, Array]:
        """Return the tool pose and the Jacobian, shape (6, n): m/s, then rad/s, in world axes."""
        ...


class ArmState:
    """The measured arm; its control loop refills one instance at every control period.

    Attributes:
        position: Measured joints, (n,), rad.
        velocity: Measured joint velocities, (n,), rad/s.
        external_nm: Estimated external joint torque, (n,).
        wrench: Force and torque of the environment on the tool at the tool centre point, (6,), world axes.
        kinematics: Used by this loop only.
    """

    def __init__(self, kinematics: ToolKinematics) -> None:
        n = kinematics.dof
        self.kinematics = kinematics
        self.position = np.zeros(n)
        self.velocity = np.zeros(n)
        self.external_nm = np.zeros(n)
        self.wrench = np.zeros(6)
        self._tool: tuple[RigidTransform, Array] | None = None

    def refill(self, position: Array, velocity: Array) -> None:
        """Set the joints of a new control period."""
        self.position[:] = position
        self.velocity[:] = velocity
        self._tool = None

    @property
    def tool(self) -> RigidTransform:
        """Measured pose of the tool centre point in the world."""
        return self._at_tool()[0]

    @property
    def jacobian(self) -> Array:
        """Jacobian at the tool centre point, (6, n), world axes."""
        return self._at_tool()[1]

    def _at_tool(self) -> tuple[RigidTransform, Array]:
        if self._tool is None:
            self._tool = self.kinematics.tool_pose_and_jacobian(self.position)
        return self._tool

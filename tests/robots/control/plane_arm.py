"""An arm of two joints in the x-y plane, links of half a metre: kinematics short enough to check by hand."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.model.transform import RigidTransform, quaternion_of
from robots.port import Array

LINK_M = 0.5


class PlaneKinematics:
    """Implements `ToolKinematics`: the tool is at the end of the second link, its x axis along the link."""

    dof = 2

    def tool_pose(self, joints: Array) -> RigidTransform:
        """Pose of the tip."""
        return self.tool_pose_and_jacobian(joints)[0]

    def tool_pose_and_jacobian(self, joints: Array) -> tuple[RigidTransform, Array]:
        """Pose of the tip and the Jacobian, (6, 2)."""
        shoulder, both = float(joints[0]), float(joints[0] + joints[1])
        elbow = LINK_M * np.array([np.cos(shoulder), np.sin(shoulder), 0.0])
        tip = elbow + LINK_M * np.array([np.cos(both), np.sin(both), 0.0])
        jacobian = np.zeros((6, 2))
        jacobian[:3, 0] = (-tip[1], tip[0], 0.0)
        jacobian[:3, 1] = (elbow[1] - tip[1], tip[0] - elbow[0], 0.0)
        jacobian[5] = 1.0
        return RigidTransform(xyz=tip, xyzw=quaternion_of(np.array([0.0, 0.0, both]))), jacobian


def plane_state(position: Array | None = None, velocity: Array | None = None) -> ArmState:
    """Return the measured state of such an arm, at zero and at rest if not said otherwise."""
    state = ArmState(PlaneKinematics())
    state.refill(np.zeros(2) if position is None else position, np.zeros(2) if velocity is None else velocity)
    return state

"""Kinematics of one arm at its base pose in the cell: tool pose, Jacobian, distance to singularity."""

from __future__ import annotations

from typing import Any

import numpy as np

from robots.model.arm_base import ArmBase
from robots.model.mechanics.pinocchio_model import arm_model, pin
from robots.model.robot_model import JointLimits, RobotModel
from robots.model.transform import RigidTransform, product
from robots.port import Array

_AT_THE_LINK = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


class ArmKinematics:
    """Pose and velocity of the tool centre point; poses are in the world frame.

    One instance serves one thread at a time; `twin` creates one for another thread.

    Args:
        model: The arm; its tool's joints are locked at 0.
        base: Pose of the model's base link in the world; an `ArmBase` is shared with others, and may move.
        tool: The tool centre point in the frame of the model's tool link; by default its origin.
    """

    def __init__(
        self,
        model: RobotModel,
        *,
        base: RigidTransform | ArmBase,
        tool: RigidTransform | None = None,
        solver: Any = None,
    ) -> None:
        self.model = model
        self.stand = ArmBase.of(base)
        """Where its base stands, shared with all instances that were made from this one."""
        self.tool = tool or _AT_THE_LINK
        self._solver = arm_model(model) if solver is None else solver
        self._data = self._solver.createData()
        self._tool = self._solver.getFrameId(model.tool_link)
        self._offset = _Offset(self._solver.frames[self._tool], self.tool) if tool is not None else None
        self._armature = np.diag(model.armature_kg_m2)

    @property
    def base(self) -> RigidTransform:
        """Pose of the base link in the world now."""
        return self.stand.pose

    @property
    def dof(self) -> int:
        """Number of arm joints n."""
        return self.model.dof

    @property
    def limits(self) -> JointLimits:
        """Limits of the arm joints."""
        return self.model.limits

    def twin(self) -> ArmKinematics:
        """Return an instance for use by another thread."""
        return ArmKinematics(self.model, base=self.stand, tool=self._own_tool(), solver=self._solver)

    def with_tool(self, tool: RigidTransform) -> ArmKinematics:
        """Return a separate instance with the tool centre point at `tool` in the frame of the tool link."""
        return ArmKinematics(self.model, base=self.stand, tool=tool, solver=self._solver)

    def tool_link_at_flange(self) -> RigidTransform:
        """Return the pose of the tool link in the frame of the flange."""
        frames = self._solver.frames
        flange = frames[self._solver.getFrameId(self.model.flange_link)].placement
        placement = flange.actInv(frames[self._tool].placement)
        return RigidTransform.of(placement.translation, pin.Quaternion(placement.rotation).coeffs())

    def mass_matrix(self, joints: Array) -> Array:
        """Return the arm's mass matrix, (n, n), kg m², including motor inertia."""
        return pin.crba(self._solver, self._data, joints) + self._armature

    def tool_pose(self, joints: Array) -> RigidTransform:
        """Return the tool centre point in the world for joints of shape (n,)."""
        pin.forwardKinematics(self._solver, self._data, joints)
        return self._tool_in_world()

    def tool_pose_and_jacobian(self, joints: Array) -> tuple[RigidTransform, Array]:
        """Return the tool pose and the Jacobian, shape (6, n): tool velocity (m/s, then rad/s, in world axes)."""
        # computeFrameJacobian would keep the frame placements of an earlier configuration.
        pin.computeJointJacobians(self._solver, self._data, joints)
        pose = self._tool_in_world()
        offset = self._offset
        if offset is None:
            jacobian = pin.getFrameJacobian(self._solver, self._data, self._tool, pin.LOCAL_WORLD_ALIGNED)
        else:
            jacobian = pin.getFrameJacobian(
                self._solver, self._data, offset.joint, offset.placement, pin.LOCAL_WORLD_ALIGNED
            )
        return pose, self.stand.turn @ jacobian

    def link_speeds(self, joints: Array, velocity: Array) -> Array:
        """Return the speed of the origin (m/s) and the angular speed (rad/s) of the link behind each joint, (n, 2)."""
        pin.forwardKinematics(self._solver, self._data, joints, velocity)
        motions = [self._data.v[joint] for joint in range(1, self._solver.njoints)]
        rows = [(float(np.linalg.norm(one.linear)), float(np.linalg.norm(one.angular))) for one in motions]
        return np.array(rows, dtype=np.float64)

    def link_lengths_m(self) -> Array:
        """Return the distance from the origin of each joint to that of the next one, (n - 1,)."""
        placements = [self._solver.jointPlacements[joint].translation for joint in range(2, self._solver.njoints)]
        return np.array([float(np.linalg.norm(xyz)) for xyz in placements], dtype=np.float64)

    def dexterity(self, joints: Array) -> float:
        """Return the distance to a singularity: the smallest singular value of the Jacobian.

        Metres and radians are weighted equally; below about 0.03 a Panda turns some joint more than
        thirty times as fast as its tool moves.
        """
        _, jacobian = self.tool_pose_and_jacobian(joints)
        return float(np.linalg.svd(jacobian, compute_uv=False)[-1])

    def _own_tool(self) -> RigidTransform | None:
        return None if self._offset is None else self.tool

    def _tool_in_world(self) -> RigidTransform:
        offset = self._offset
        if offset is None:
            placement = pin.updateFramePlacement(self._solver, self._data, self._tool)
        else:
            placement = self._data.oMi[offset.joint] * offset.placement
        # Equals base.then(…), without recomputing its rotation in every control period.
        xyzw = np.array(pin.Quaternion(placement.rotation).coeffs())
        stand = self.stand
        base = stand.pose
        return RigidTransform(xyz=base.xyz + stand.rotation @ placement.translation, xyzw=product(base.xyzw, xyzw))


class _Offset:
    """A tool centre point away from the origin of the tool link: its parent joint and its pose."""

    def __init__(self, frame: Any, tool: RigidTransform) -> None:
        self.joint: int = frame.parentJoint
        self.placement: Any = frame.placement * pin.SE3(tool.rotation, tool.xyz)

"""Kinematics of one arm at its place in the cell: tool pose, Jacobian, distance to singularity."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from engine.errors import CellError
from robots.model.rigid import Rigid
from robots.model.robot_model import JointLimits, RobotModel
from robots.port import Array

# pinocchio has no stubs, and its wheel puts it where type checkers do not look: it stays behind
# this class, which hands out numpy arrays.
pin: Any = import_module("pinocchio")


class ArmKinematics:
    """Where the tool centre point is and how it moves; poses are in the world frame.

    One instance serves one thread at a time; `twin` makes another one for another thread.

    Args:
        model: The arm; every joint of its URDF that is not an arm joint (fingers) is locked at 0.
        base: Pose of the model's base link in the world.
    """

    def __init__(self, model: RobotModel, *, base: Rigid, solver: Any = None) -> None:
        self.model = model
        self.base = base
        self._solver = _reduced(model) if solver is None else solver
        self._data = self._solver.createData()
        self._tool = self._solver.getFrameId(model.tool_link)
        self._to_base = base.inverse()
        self._turn = np.kron(np.eye(2), base.rotation)

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
        return ArmKinematics(self.model, base=self.base, solver=self._solver)

    def tool_pose(self, joints: Array) -> Rigid:
        """Return the tool centre point in the world for joints of shape (n,)."""
        pin.forwardKinematics(self._solver, self._data, joints)
        return self.base.then(self._tool_in_base())

    def tool_pose_and_jacobian(self, joints: Array) -> tuple[Rigid, Array]:
        """Return the tool pose and the Jacobian, shape (6, n): tool velocity (m/s, then rad/s, in world axes)."""
        # computeFrameJacobian would leave the frame placements of an earlier configuration.
        pin.computeJointJacobians(self._solver, self._data, joints)
        pose = self._tool_in_base()
        jacobian = pin.getFrameJacobian(self._solver, self._data, self._tool, pin.LOCAL_WORLD_ALIGNED)
        return self.base.then(pose), self._turn @ jacobian

    def dexterity(self, joints: Array) -> float:
        """Return how far the arm is from a singularity: the smallest singular value of the Jacobian.

        Metres and radians are weighed alike; below about 0.03 a Panda turns some joint more than
        thirty times as fast as its tool moves.
        """
        _, jacobian = self.tool_pose_and_jacobian(joints)
        return float(np.linalg.svd(jacobian, compute_uv=False)[-1])

    def _tool_in_base(self) -> Rigid:
        placement = pin.updateFramePlacement(self._solver, self._data, self._tool)
        return Rigid(xyz=placement.translation.copy(), xyzw=np.array(pin.Quaternion(placement.rotation).coeffs()))


def _reduced(model: RobotModel) -> Any:
    full = pin.buildModelFromUrdf(str(model.urdf))
    for joint in model.arm_joints:
        if not full.existJointName(joint):
            raise CellError(f"the URDF has no joint {joint}", where=model.urdf, hint="correct the robot model")
    if not full.existFrame(model.tool_link):
        raise CellError(f"the URDF has no link {model.tool_link}", where=model.urdf, hint="correct the robot model")
    locked = [full.getJointId(name) for name in list(full.names)[1:] if name not in model.arm_joints]
    reduced = pin.buildReducedModel(full, locked, pin.neutral(full))
    if tuple(reduced.names)[1:] != model.arm_joints:
        raise CellError("the joints of the robot model are not in the order of the URDF", where=model.urdf)
    return reduced

"""Computes the joints and tool poses of a configuration, pose, recording or primitive without moving the arm."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from engine.bus import SkillBus
from engine.errors import RobotError, SkillFailed
from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, JointDmp
from engine.skills.motion_trace import Trace, TraceMotion
from engine.store import Joints
from robots.arm.execution.motion_runner import MotionRunner
from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.dmp import integrate_joints, integrate_pose, joints_in_task_frame, poses_in_task_frame
from robots.port import Array

_TYPES = {"joints": Joints, "pose": Pose, "trajectory": Trajectory, "dmp": JointDmp, "cart_dmp": CartDmp}


@dataclass(frozen=True, kw_only=True)
class _PreviewPath:
    """Times (rows,), and the joints (rows, n) or tool poses in the world at each of them."""

    times_s: Array
    names: tuple[str, ...] = ()
    joints: Array | None = None
    tools: Sequence[RigidTransform] = ()


class ForwardPreview:
    """Serves TraceMotion."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the service under the arm's name; it moves nothing and needs no lease."""
        bus.advertise_service(TraceMotion, self._trace, namespace=self._runner.name)

    async def _trace(self, request: TraceMotion) -> Trace:
        runner = self._runner
        seed = runner.port.sample().position_rad.copy()
        try:
            value = msgspec.convert(request.value, _TYPES[request.kind])
            # Separate kinematics: a motion may be planned at the same time.
            kinematics = runner.kinematics.twin()
            await runner.loaded()
            with np.errstate(all="ignore"):
                if runner.clock.virtual:
                    return self._compute_trace(value, kinematics, seed, request.most)
                return await asyncio.to_thread(self._compute_trace, value, kinematics, seed, request.most)
        except msgspec.ValidationError as error:
            raise SkillFailed(f"not a valid {request.kind}: {error}", where=runner.name) from error
        except RobotError as error:
            raise SkillFailed(error.message, where=runner.name, hint=error.hint) from None
        except (ArithmeticError, ValueError) as error:
            raise SkillFailed(
                f"the motion cannot be computed from these numbers: {error}", where=runner.name
            ) from error

    def _compute_trace(self, value: object, kinematics: ArmKinematics, seed: Array, most: int) -> Trace:
        preview = _downsampled(self._preview_path(value), most)
        joints, remark = preview.joints, ""
        if joints is None:
            joints, remark = _solve_poses(InverseKinematicsSolver(kinematics), preview.tools, seed)
            tools = preview.tools
        else:
            self._check(joints, preview.names)
            tools = tuple(kinematics.tool_pose(row) for row in joints)
        return Trace(
            times_s=tuple(preview.times_s.tolist()),
            joint_names=self._runner.model.arm_joints,
            joints=tuple(tuple(row) for row in joints.tolist()),
            poses=tuple((*tool.xyz.tolist(), *tool.xyzw.tolist()) for tool in tools),
            remark=remark,
        )

    def _preview_path(self, value: object) -> _PreviewPath:
        match value:
            case Joints():
                return _PreviewPath(times_s=np.zeros(1), names=value.names, joints=np.array([value.joints]))
            case Pose():
                return _PreviewPath(times_s=np.zeros(1), tools=(self._runner.frames.to_world(value),))
            case Trajectory() if value.joints:
                return _PreviewPath(times_s=np.array(value.times_s), names=value.names, joints=np.array(value.joints))
            case Trajectory():
                return _PreviewPath(times_s=np.array(value.times_s), tools=self._in_world(value.poses, value.frame))
            case JointDmp():
                path = integrate_joints(joints_in_task_frame(value))
                return _PreviewPath(times_s=path.shares * value.tau, joints=path.position)
            case CartDmp():
                integrated = integrate_pose(poses_in_task_frame(value))
                poses = np.hstack((integrated.xyz, integrated.xyzw)).tolist()
                return _PreviewPath(times_s=integrated.shares * value.tau, tools=self._in_world(poses, value.frame))
            case _:
                raise RobotError("this kind of entry has no position to preview")

    def _in_world(self, poses: Sequence[Sequence[float]], frame: str) -> tuple[RigidTransform, ...]:
        base = self._runner.frames.to_world(Pose(xyz=(0.0, 0.0, 0.0), frame=frame))
        return tuple(base.then(RigidTransform.of(pose[:3], pose[3:])) for pose in poses)

    def _check(self, joints: Array, names: tuple[str, ...]) -> None:
        model = self._runner.model
        if joints.shape[1] != model.dof or (names and names != model.arm_joints):
            raise RobotError(
                f"the entry has the joints {', '.join(names)}" if names else f"the entry has {joints.shape[1]} joints",
                hint=f"this arm has {', '.join(model.arm_joints)}",
            )


def _downsampled(preview: _PreviewPath, most: int) -> _PreviewPath:
    rows = len(preview.times_s)
    if rows <= most:
        return preview
    kept: list[int] = np.unique(np.linspace(0, rows - 1, most).round().astype(int)).tolist()
    return _PreviewPath(
        times_s=preview.times_s[kept],
        names=preview.names,
        joints=None if preview.joints is None else preview.joints[kept],
        tools=[preview.tools[index] for index in kept] if preview.tools else (),
    )


def _solve_poses(inverse: InverseKinematicsSolver, tools: Sequence[RigidTransform], seed: Array) -> tuple[Array, str]:
    """Return the joints at each pose, or no joints and the reason if the arm does not reach one."""
    rows: list[Array] = []
    joints = seed
    for index, tool in enumerate(tools):
        tracked = inverse.track(tool, seed=joints) if rows else None
        try:
            joints = tracked if tracked is not None else inverse.nearest(tool, seed=joints)
        except RobotError as error:
            share = f" after {index / len(tools):.0%} of the path" if index else ""
            return np.zeros((0, len(seed))), f"pose not reachable{share}: {error.message}"
        rows.append(joints)
    return np.array(rows), ""

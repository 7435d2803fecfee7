"""Says where the arm would be along a configuration, pose, recording or primitive, without moving it."""

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
from engine.store.entry_kinds import Joints
from robots.arm.motion_runner import MotionRunner
from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.model.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.dmp import integrate_joints, integrate_pose, joints_in_task_frame, poses_in_task_frame
from robots.port import Array

_TYPES = {"joints": Joints, "pose": Pose, "trajectory": Trajectory, "dmp": JointDmp, "cart_dmp": CartDmp}


@dataclass(frozen=True, kw_only=True)
class _PreviewPath:
    """Times, and what an entry says of each of them: joints (rows, n), or tool poses in the world."""

    times_s: Array
    names: tuple[str, ...] = ()
    joints: Array | None = None
    tools: Sequence[RigidTransform] = ()


class ForwardPreview:
    """Answers TraceMotion."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner

    def register(self, bus: SkillBus) -> None:
        """Advertise the service under the arm's name; it moves nothing and is open to all."""
        bus.advertise_service(TraceMotion, self._trace, namespace=self._runner.name)

    async def _trace(self, request: TraceMotion) -> Trace:
        runner = self._runner
        seed = runner.port.sample().position_rad.copy()
        try:
            value = msgspec.convert(request.value, _TYPES[request.kind])
            # Kinematics of its own: a motion may be planned meanwhile.
            kinematics = runner.kinematics.twin()
            await runner.loaded()
            with np.errstate(all="ignore"):
                if runner.clock.virtual:
                    return self._traced(value, kinematics, seed, request.most)
                return await asyncio.to_thread(self._traced, value, kinematics, seed, request.most)
        except msgspec.ValidationError as error:
            raise SkillFailed(f"this is no {request.kind}: {error}", where=runner.name) from error
        except RobotError as error:
            raise SkillFailed(error.message, where=runner.name, hint=error.hint) from None
        except (ArithmeticError, ValueError) as error:
            raise SkillFailed(f"nothing can be worked out from these numbers: {error}", where=runner.name) from error

    def _traced(self, value: object, kinematics: ArmKinematics, seed: Array, most: int) -> Trace:
        way = _picked(self._way(value), most)
        joints, remark = way.joints, ""
        if joints is None:
            joints, remark = _followed(InverseKinematicsSolver(kinematics), way.tools, seed)
            tools = way.tools
        else:
            self._check(joints, way.names)
            tools = tuple(kinematics.tool_pose(row) for row in joints)
        return Trace(
            times_s=tuple(way.times_s.tolist()),
            joint_names=self._runner.model.arm_joints,
            joints=tuple(tuple(row) for row in joints.tolist()),
            poses=tuple((*tool.xyz.tolist(), *tool.xyzw.tolist()) for tool in tools),
            remark=remark,
        )

    def _way(self, value: object) -> _PreviewPath:
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
                rolled = integrate_pose(poses_in_task_frame(value))
                poses = np.hstack((rolled.xyz, rolled.xyzw)).tolist()
                return _PreviewPath(times_s=rolled.shares * value.tau, tools=self._in_world(poses, value.frame))
            case _:
                raise RobotError("this kind of entry has no place")

    def _in_world(self, poses: Sequence[Sequence[float]], frame: str) -> tuple[RigidTransform, ...]:
        base = self._runner.frames.to_world(Pose(xyz=(0.0, 0.0, 0.0), frame=frame))
        return tuple(base.then(RigidTransform.of(pose[:3], pose[3:])) for pose in poses)

    def _check(self, joints: Array, names: tuple[str, ...]) -> None:
        model = self._runner.model
        if joints.shape[1] != model.dof or (names and names != model.arm_joints):
            raise RobotError(
                f"this is of the joints {', '.join(names)}" if names else f"this is of {joints.shape[1]} joints",
                hint=f"this arm has {', '.join(model.arm_joints)}",
            )


def _picked(way: _PreviewPath, most: int) -> _PreviewPath:
    rows = len(way.times_s)
    if rows <= most:
        return way
    kept: list[int] = np.unique(np.linspace(0, rows - 1, most).round().astype(int)).tolist()
    return _PreviewPath(
        times_s=way.times_s[kept],
        names=way.names,
        joints=None if way.joints is None else way.joints[kept],
        tools=[way.tools[index] for index in kept] if way.tools else (),
    )


def _followed(inverse: InverseKinematicsSolver, tools: Sequence[RigidTransform], seed: Array) -> tuple[Array, str]:
    """Return the joints at each pose; none, and why, where the arm does not reach one."""
    rows: list[Array] = []
    here = seed
    for index, tool in enumerate(tools):
        found = inverse.track(tool, seed=here) if rows else None
        try:
            here = found if found is not None else inverse.nearest(tool, seed=here)
        except RobotError as error:
            share = f" after {index / len(tools):.0%} of the way" if index else ""
            return np.zeros((0, len(seed))), f"the arm does not get there{share}: {error.message}"
        rows.append(here)
    return np.array(rows), ""

"""One arm as a robot of the cell: answers the motion skills over an `ArmPort`, simulated or real."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from types import TracebackType
from typing import Self

import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.clock import Clock
from engine.errors import GoalRejected, RobotError, SkillFailed
from engine.messages import Pose, RobotDescription
from engine.robot import DeviceStatus
from engine.skills.motion import (
    CartLinTask,
    CartMotionFeedback,
    CartMotionResult,
    CartTrapVel,
    ForwardKinematics,
    JointMotionFeedback,
    JointMotionResult,
    JointTrapVel,
)
from robots.arm.planner import ArmPlanner
from robots.arm.tool_frames import WORLD, ToolFrames
from robots.attend import attend
from robots.gripper.grip_judgement import Grip
from robots.gripper.gripper_server import GripperServer
from robots.model.kinematics import ArmKinematics
from robots.model.rigid import Rigid
from robots.model.robot_model import RobotModel
from robots.port import ArmPort, Array, JointTrajectory, Motion, Tolerance

_REST_RAD_S = 0.02
# How long a moving arm may take to come to rest, and how often that is looked at.
_BRAKING_S, _LOOK_S = 2.0, 0.01


class ArmServer:
    """Implements `engine.robot.Robot`; one motion goal at a time, the gripper on the arm beside it.

    Args:
        name: Bus namespace and resource of the arm.
        model: The kind of arm.
        base: Pose of the arm's base link in the world.
        port: What moves it; connected by its owner before this robot is entered.
        clock: Decides where plans are made.
        gripper: The gripper on the arm, if any; served and stopped together with it.
        tolerance: How closely the port must follow.
    """

    def __init__(
        self,
        *,
        name: str,
        model: RobotModel,
        base: Pose,
        port: ArmPort,
        clock: Clock,
        gripper: GripperServer | None = None,
        tolerance: Tolerance | None = None,
    ) -> None:
        placement = Rigid.from_pose(base)
        self._name = name
        self._model = model
        self._port = port
        self._gripper = gripper
        self._tolerance = tolerance or Tolerance()
        self._clock = clock
        self._kinematics = ArmKinematics(model, base=placement)
        self._planner = ArmPlanner(self._kinematics.twin(), clock=clock)
        self._frames = ToolFrames(arm=name, base_link=model.base_link, base=placement)
        self._motion: Motion | None = None
        self._stops = 0
        self._status = DeviceStatus.DISCONNECTED

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._name

    @property
    def status(self) -> DeviceStatus:
        """MOVING while a goal is carried out by arm or gripper."""
        fingers_move = self._gripper is not None and self._gripper.moving
        if self._status is DeviceStatus.READY and (self._motion is not None or fingers_move):
            return DeviceStatus.MOVING
        return self._status

    def register(self, bus: SkillBus) -> None:
        """Advertise the motion skills under the arm's name and publish `<name>/description`."""
        bus.advertise_action(JointTrapVel, self._joint_trap_vel, namespace=self._name, exclusive=self._name)
        bus.advertise_action(CartTrapVel, self._cart_trap_vel, namespace=self._name, exclusive=self._name)
        bus.advertise_action(CartLinTask, self._cart_lin_task, namespace=self._name, exclusive=self._name)
        bus.advertise_service(ForwardKinematics, self._forward_kinematics, namespace=self._name)
        bus.topic(f"{self._name}/description", RobotDescription).publish(self.description())
        if self._gripper is not None:
            self._gripper.register(bus)

    def description(self) -> RobotDescription:
        """Return what this arm is: limits, base and the URDF's text."""
        model, limits = self._model, self._model.limits
        return RobotDescription(
            name=self._name,
            model=model.name,
            urdf=model.urdf.read_text(encoding="utf-8"),
            joint_names=model.arm_joints,
            lower_rad=limits.lower_rad,
            upper_rad=limits.upper_rad,
            velocity_rad_s=limits.velocity_rad_s,
            acceleration_rad_s2=limits.acceleration_rad_s2,
            base=self._frames.base.to_pose(WORLD),
            tool_frame=f"{self._name}/{model.tool_link}",
            licence=model.licence,
        )

    def grips(self) -> dict[str, Grip]:
        """What the gripper was told to grasp and hold, by its name; empty when nothing."""
        gripper = self._gripper
        return {} if gripper is None or gripper.grip is None else {gripper.name: gripper.grip}

    def recall(self, grips: Mapping[str, Grip]) -> None:
        """Judge by `grips` from now on whether the gripper holds what it was told to grasp."""
        if self._gripper is not None:
            self._gripper.grip = grips.get(self._gripper.name)

    async def stop(self) -> None:
        """Cancel what arm and gripper do; return when the arm is measured at rest.

        Raises:
            RobotError: it still moves.
        """
        self._stops += 1
        motion = self._motion
        if motion is not None:
            motion.cancel()
        try:
            if self._gripper is not None:
                await self._gripper.stop()
        finally:
            # The arm brakes first and is waited for, whatever becomes of the fingers.
            if motion is not None:
                await motion.report()
        if self._status is not DeviceStatus.DISCONNECTED:
            await self._confirm_rest()

    async def _confirm_rest(self) -> None:
        """Return when the arm is measured at rest; whoever else moved it is being stopped as well."""
        patience_s = self._clock.now_s() + _BRAKING_S
        while True:
            speed = np.abs(self._port.sample().velocity_rad_s)
            fastest = int(np.argmax(speed))
            if speed[fastest] <= _REST_RAD_S:
                return
            if self._clock.now_s() >= patience_s:
                self._status = DeviceStatus.FAULT
                raise RobotError(
                    f"{self._model.arm_joints[fastest]} still moves at {speed[fastest]:.3f} rad/s after the stop",
                    where=self._name,
                    hint="use the emergency stop",
                )
            await self._clock.sleep(_LOOK_S)

    async def __aenter__(self) -> Self:
        names = self._port.joint_names
        if names != self._model.arm_joints:
            raise RobotError(
                f"the arm reports the joints {', '.join(names)}",
                where=self._name,
                hint=f"the model {self._model.name} has {', '.join(self._model.arm_joints)}: correct `model`",
            )
        self._status = DeviceStatus.READY
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            await self.stop()
        finally:
            self._status = DeviceStatus.DISCONNECTED

    async def _joint_trap_vel(self, goal: JointTrapVel, handle: ActiveGoal[JointMotionFeedback]) -> JointMotionResult:
        trajectory = await self._planned(
            handle, lambda start: self._planner.to_joints(start, np.array(goal.joints), speed=goal.speed)
        )

        def tell(motion: Motion) -> None:
            handle.feedback(JointMotionFeedback(joints=self._measured(), progress=motion.progress))

        duration_s = await self._carry_out(trajectory, handle, tell)
        return JointMotionResult(joints=self._measured(), duration_s=duration_s)

    async def _cart_trap_vel(self, goal: CartTrapVel, handle: ActiveGoal[CartMotionFeedback]) -> CartMotionResult:
        return await self._cartesian(
            goal.pose, handle, lambda start, pose: self._planner.to_pose(start, pose, speed=goal.speed)
        )

    async def _cart_lin_task(self, goal: CartLinTask, handle: ActiveGoal[CartMotionFeedback]) -> CartMotionResult:
        return await self._cartesian(
            goal.pose, handle, lambda start, pose: self._planner.along_line(start, pose, duration_s=goal.duration_s)
        )

    async def _forward_kinematics(self, request: ForwardKinematics) -> Pose:
        if not request.joints:
            return self._measured_pose()
        if len(request.joints) != self._model.dof:
            raise SkillFailed(
                f"{len(request.joints)} joints were given", where=self._name, hint=f"this arm has {self._model.dof}"
            )
        return self._kinematics.tool_pose(np.array(request.joints)).to_pose(WORLD)

    async def _cartesian(
        self,
        pose: Pose,
        handle: ActiveGoal[CartMotionFeedback],
        plan: Callable[[Array, Rigid], Awaitable[JointTrajectory]],
    ) -> CartMotionResult:
        try:
            target = self._frames.to_world(pose)
        except RobotError as error:
            raise GoalRejected(error.message, where=handle.address, hint=error.hint) from None
        trajectory = await self._planned(handle, lambda start: plan(start, target))

        def tell(motion: Motion) -> None:
            handle.feedback(CartMotionFeedback(pose=self._measured_pose(), progress=motion.progress))

        duration_s = await self._carry_out(trajectory, handle, tell)
        return CartMotionResult(pose=self._measured_pose(), duration_s=duration_s)

    async def _planned(
        self,
        handle: ActiveGoal[JointMotionFeedback] | ActiveGoal[CartMotionFeedback],
        plan: Callable[[Array], Awaitable[JointTrajectory]],
    ) -> JointTrajectory:
        """Plan from the set point and accept the goal, or reject it with the reason."""
        if self._status is not DeviceStatus.READY:
            raise GoalRejected(f"the arm is {self._status.value}", where=handle.address, hint="connect it first")
        stops = self._stops
        try:
            trajectory = await plan(self._port.sample().desired_rad)
        except RobotError as error:
            # The refusal says it all: a second link with the same words would explain nothing.
            raise GoalRejected(error.message, where=handle.address, hint=error.hint) from None
        if self._stops != stops:
            raise GoalRejected("the arm was stopped while the motion was planned", where=handle.address)
        handle.accept()
        return trajectory

    async def _carry_out(
        self,
        trajectory: JointTrajectory,
        handle: ActiveGoal[JointMotionFeedback] | ActiveGoal[CartMotionFeedback],
        tell: Callable[[Motion], None],
    ) -> float:
        """Follow to the end and return the time it took; a cancelled goal returns as well, at rest."""
        started_s = self._clock.now_s()
        try:
            motion = self._port.follow(trajectory, tolerance=self._tolerance)
        except RobotError as error:
            raise SkillFailed("the motion was not started", where=handle.address) from error
        self._motion = motion
        try:
            await attend(motion, handle, tell=lambda: tell(motion), device=self._name, words="the arm")
        finally:
            self._motion = None
        return self._clock.now_s() - started_s

    def _measured(self) -> tuple[float, ...]:
        return tuple(self._port.sample().position_rad.tolist())

    def _measured_pose(self) -> Pose:
        return self._kinematics.tool_pose(self._port.sample().position_rad).to_pose(WORLD)

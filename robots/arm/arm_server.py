"""One arm as a robot of the cell: answers the motion skills over an `ArmPort`, simulated or real."""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Protocol, Self

from engine.bus import SkillBus
from engine.clock import Clock
from engine.errors import RobotError
from engine.messages import Pose, RobotDescription
from engine.robot import DeviceStatus
from robots.arm.arm_control_services import ArmControlServices
from robots.arm.arm_status import ArmStatusPublisher
from robots.arm.attached_part_guard import AttachedPartGuard
from robots.arm.contact_motions import ContactMotions
from robots.arm.direct_control import DirectControl
from robots.arm.dmp_motions import DmpMotions
from robots.arm.force_motions import ForceMotions
from robots.arm.forward_preview import ForwardPreview
from robots.arm.free_motions import FreeMotions
from robots.arm.guiding_motions import GuidingMotions
from robots.arm.inverse_kinematics_services import InverseKinematicsServices
from robots.arm.jog_motions import JogMotions
from robots.arm.motion_runner import MotionRunner
from robots.arm.output_services import OutputServices
from robots.arm.path_motions import PathMotions
from robots.arm.tool_frames import WORLD
from robots.gripper.grasp_check import GraspCommand
from robots.gripper.tool_server import ToolServer
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.port import ArmPort, Tolerance
from robots.workspace.workspace import Workspace


class SkillGroup(Protocol):
    """Some of an arm's skills; made once an arm, around its `MotionRunner`."""

    def register(self, bus: SkillBus) -> None:
        """Advertise them under the arm's name."""
        ...


class ArmServer:
    """Implements `engine.robot.Robot`; one motion goal at a time, the gripper on the arm beside it.

    Args:
        name: Bus namespace and resource of the arm.
        model: The kind of arm.
        base: Pose of the arm's base link in the world.
        port: What moves it; connected by its owner before this robot is entered.
        clock: Decides where plans are made.
        gripper: The gripper, hand or magnet on the arm, if any; served and stopped together with it.
        outputs: The digital outputs of its controller, if any.
        tolerance: How closely the port must follow.
        workspace: The space it shares with others; without one it has no collision-free motions, and
            nothing is known of what it holds.
    """

    def __init__(
        self,
        *,
        name: str,
        model: RobotModel,
        base: Pose,
        port: ArmPort,
        clock: Clock,
        gripper: ToolServer | None = None,
        outputs: OutputServices | None = None,
        tolerance: Tolerance | None = None,
        workspace: Workspace | None = None,
    ) -> None:
        self._runner = runner = MotionRunner(
            name=name,
            model=model,
            base=RigidTransform.from_pose(base),
            port=port,
            clock=clock,
            tolerance=tolerance or Tolerance(),
            carry=AttachedPartGuard(name, workspace) if workspace is not None else None,
        )
        self._gripper = gripper
        self._report = report = ArmStatusPublisher(runner)
        self._groups: tuple[SkillGroup, ...] = (
            PathMotions(runner),
            InverseKinematicsServices(runner),
            ForwardPreview(runner),
            DmpMotions(runner),
            ForceMotions(runner),
            ContactMotions(runner),
            JogMotions(runner, workspace),
            GuidingMotions(runner),
            DirectControl(runner),
            ArmControlServices(runner, report),
            report,
            *((outputs,) if outputs is not None else ()),
            *((FreeMotions(runner, workspace),) if workspace is not None else ()),
        )

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._runner.name

    @property
    def status(self) -> DeviceStatus:
        """MOVING while a goal is carried out by arm or gripper."""
        runner = self._runner
        fingers_move = self._gripper is not None and self._gripper.moving
        if runner.status is DeviceStatus.READY and (runner.moving or fingers_move):
            return DeviceStatus.MOVING
        return runner.status

    def register(self, bus: SkillBus) -> None:
        """Advertise the motion skills under the arm's name and publish `<name>/description`."""
        for group in self._groups:
            group.register(bus)
        bus.topic(f"{self.name}/description", RobotDescription).publish(self.description())
        if self._gripper is not None:
            self._gripper.register(bus)

    def description(self) -> RobotDescription:
        """Return what this arm is: limits, base and the URDF's text."""
        model, limits = self._runner.model, self._runner.model.limits
        return RobotDescription(
            name=self.name,
            model=model.name,
            urdf=model.urdf_text,
            joint_names=model.arm_joints,
            lower_rad=limits.lower_rad,
            upper_rad=limits.upper_rad,
            velocity_rad_s=limits.velocity_rad_s,
            acceleration_rad_s2=limits.acceleration_rad_s2,
            base=self._runner.frames.base.to_pose(WORLD),
            tool_frame=f"{self.name}/{model.tool_link}",
            licence=model.licence,
            effort_nm=limits.effort_nm,
            jerk_rad_s3=limits.jerk_rad_s3,
            tool=model.tool.name if model.tool is not None else "",
            tool_kind=model.tool.kind if model.tool is not None else "",
            tool_licence=model.tool.licence if model.tool is not None else "",
            calibration=model.calibration,
        )

    def grips(self) -> dict[str, GraspCommand]:
        """What the gripper was told to grasp and hold, by its name; empty when nothing."""
        gripper = self._gripper
        return {} if gripper is None or gripper.grip is None else {gripper.name: gripper.grip}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Judge by `grips` from now on whether the gripper holds what it was told to grasp."""
        if self._gripper is not None:
            self._gripper.grip = grips.get(self._gripper.name)

    def world_lost(self, reason: str) -> None:
        """Take no goals, and say why."""
        self._runner.lose(reason)

    def world_restored(self) -> None:
        """Take goals again."""
        self._runner.find()

    async def stop(self) -> None:
        """Cancel what arm and gripper do; return when the arm is measured at rest.

        Raises:
            RobotError: it still moves, or is out of reach.
        """
        runner = self._runner
        runner.brake()
        try:
            if self._gripper is not None:
                await self._gripper.stop()
        finally:
            # The arm brakes first and is waited for, whatever becomes of the fingers.
            await runner.stop()
        if runner.status is not DeviceStatus.DISCONNECTED:
            await runner.confirm_rest()

    async def __aenter__(self) -> Self:
        runner = self._runner
        names = runner.port.joint_names
        if names != runner.model.arm_joints:
            raise RobotError(
                f"the arm reports the joints {', '.join(names)}",
                where=self.name,
                hint=f"the model {runner.model.name} has {', '.join(runner.model.arm_joints)}: correct `model`",
            )
        runner.status = DeviceStatus.READY
        if not runner.clock.virtual:
            # In virtual time nobody waits for a wall clock: what is needed is loaded when it is.
            runner.loading.begin()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            # What is out of reach was told when it was lost; there is nothing to bring to rest from here.
            if not self._runner.lost_reason:
                await self.stop()
        finally:
            self._runner.lost_reason = ""
            self._runner.status = DeviceStatus.DISCONNECTED
            self._runner.changed()
            await self._runner.loading.finished()

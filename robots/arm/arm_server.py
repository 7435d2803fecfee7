"""One arm as a robot of the cell: serves the motion skills over an `ArmPort`, simulated or real."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Protocol, Self

from engine.bus import SkillBus
from engine.clock import Clock
from engine.errors import RobotError
from engine.messages import Pose, RobotDescription
from engine.robot import DeviceStatus
from robots.arm.contact_motions import ContactMotions
from robots.arm.direct_control import DirectControl
from robots.arm.dmp_motions import DmpMotions
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.execution.tool_frames import WORLD
from robots.arm.force_motions import ForceMotions
from robots.arm.free_motion.free_motions import FreeMotions
from robots.arm.guiding_motions import GuidingMotions
from robots.arm.identification.identification_motions import IdentificationMotions
from robots.arm.jogging.jog_motions import JogMotions
from robots.arm.path_motions import PathMotions
from robots.arm.scene_queries.path_guard import PathGuard
from robots.arm.services.arm_control_services import ArmControlServices
from robots.arm.services.arm_status import ArmStatusPublisher
from robots.arm.services.forward_preview import ForwardPreview
from robots.arm.services.input_services import InputServices
from robots.arm.services.inverse_kinematics_services import InverseKinematicsServices
from robots.arm.services.output_services import OutputServices
from robots.arm.waypoint_motions import WaypointMotions
from robots.gripper.tool_server import ToolServer
from robots.model.arm_base import ArmBase
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.port import ArmPort, GraspCommand, Tolerance
from robots.scene.sim_scene import ArmPlacement
from robots.tool_changer import ToolChangerServer
from robots.workspace.workspace import Workspace


class SkillGroup(Protocol):
    """A group of an arm's skills; created once per arm, around its `MotionRunner`."""

    def register(self, bus: SkillBus) -> None:
        """Advertise them under the arm's name."""
        ...


class ArmServer:
    """Implements `engine.robot.Robot` and `robots.port.OutputOwner`.

    It executes one motion goal at a time, the gripper in parallel.

    Args:
        name: Bus namespace and resource of the arm.
        model: Model of the arm.
        base: Pose of the arm's base link in the world, or what is shared of it.
        port: Commands the arm; connected by its owner before this robot is entered.
        clock: Virtual time plans inline, real time in a thread.
        gripper: The tool on the arm, if any; served and stopped together with it.
        outputs: The digital outputs of its controller, if any.
        inputs: The digital inputs of its controller, if any.
        tolerance: Following tolerance of the port.
        frames: Poses in the world of the named frames of the cell, in which goals may be given.
        workspace: The workspace shared with other arms; without one the arm has no collision-free motions and
            checks no path.
        tool_changer: Its tool changer, if any.
    """

    def __init__(
        self,
        *,
        name: str,
        model: RobotModel,
        base: Pose | ArmBase,
        port: ArmPort,
        clock: Clock,
        gripper: ToolServer | None = None,
        outputs: OutputServices | None = None,
        inputs: InputServices | None = None,
        tolerance: Tolerance | None = None,
        frames: Mapping[str, Pose] | None = None,
        workspace: Workspace | None = None,
        tool_changer: ToolChangerServer | None = None,
    ) -> None:
        self._runner = runner = MotionRunner(
            name=name,
            model=model,
            base=base if isinstance(base, ArmBase) else ArmBase(RigidTransform.from_pose(base)),
            port=port,
            clock=clock,
            tolerance=tolerance or Tolerance(),
            path_guard=PathGuard(name, workspace) if workspace is not None else None,
            frames=frames,
        )
        self._gripper = gripper
        self._tool_changer = tool_changer
        self._describe: Callable[[], None] = _no_operation
        self._described = runner.frames.base.to_pose(WORLD)
        self.outputs = outputs
        self.inputs = inputs
        self._report = report = ArmStatusPublisher(runner)
        self._groups: tuple[SkillGroup, ...] = (
            PathMotions(runner),
            WaypointMotions(runner),
            InverseKinematicsServices(runner),
            ForwardPreview(runner),
            DmpMotions(runner),
            ForceMotions(runner),
            ContactMotions(runner),
            JogMotions(runner, workspace, tool=gripper.name if gripper is not None else ""),
            GuidingMotions(runner),
            IdentificationMotions(runner),
            DirectControl(runner),
            ArmControlServices(runner, report),
            report,
            *((outputs,) if outputs is not None else ()),
            *((inputs,) if inputs is not None else ()),
            *((tool_changer,) if tool_changer is not None else ()),
            *((FreeMotions(runner, workspace),) if workspace is not None else ()),
        )
        if tool_changer is not None:
            tool_changer.changed = self._tool_changed

    @property
    def name(self) -> str:
        """The bus namespace of its skills."""
        return self._runner.name

    @property
    def status(self) -> DeviceStatus:
        """MOVING while the arm or gripper executes a goal."""
        runner = self._runner
        fingers_move = self._gripper is not None and self._gripper.moving
        if runner.status is DeviceStatus.READY and (runner.moving or fingers_move):
            return DeviceStatus.MOVING
        return runner.status

    def register(self, bus: SkillBus) -> None:
        """Advertise the motion skills under the arm's name and publish `<name>/description`."""
        for group in self._groups:
            group.register(bus)
        topic = bus.topic(f"{self.name}/description", RobotDescription)
        self._describe = lambda: topic.publish(self.description())
        self._describe()
        if self._gripper is not None:
            self._gripper.register(bus)

    def description(self) -> RobotDescription:
        """Return the description of this arm: limits, base pose and URDF text."""
        model, limits = self._runner.model, self._runner.model.limits
        self._described = self._runner.frames.base.to_pose(WORLD)
        changed = self._tool_changer.tool if self._tool_changer is not None else ""
        return RobotDescription(
            name=self.name,
            model=model.name,
            urdf=model.urdf_text,
            joint_names=model.arm_joints,
            lower_rad=limits.lower_rad,
            upper_rad=limits.upper_rad,
            velocity_rad_s=limits.velocity_rad_s,
            acceleration_rad_s2=limits.acceleration_rad_s2,
            base=self._described,
            tool_frame=f"{self.name}/{model.tool_link}",
            licence=model.licence,
            effort_nm=limits.effort_nm,
            jerk_rad_s3=limits.jerk_rad_s3,
            tool=model.tool.name if model.tool is not None else changed,
            tool_kind=model.tool.kind if model.tool is not None else "",
            tool_licence=model.tool.licence if model.tool is not None else "",
            calibration=model.calibration,
        )

    def take_placement(self, placement: ArmPlacement) -> None:
        """Stand where the cell has the base now; everything that computes with this arm follows."""
        frames, stand = self._runner.frames, self._runner.kinematics.stand
        frames.loose = placement.loose
        if placement.base != stand.pose.to_pose(WORLD):
            stand.stand_at(RigidTransform.from_pose(placement.base))
        if not placement.loose and placement.base != self._described:
            self._describe()

    def grips(self) -> dict[str, GraspCommand]:
        """Return the grasp command that the gripper executes or holds, by the gripper's name; empty without one."""
        gripper = self._gripper
        return {} if gripper is None or gripper.grip is None else {gripper.name: gripper.grip}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Restore the grasp commands by which the gripper checks whether it holds its part."""
        if self._gripper is not None:
            self._gripper.grip = grips.get(self._gripper.name)

    def world_lost(self, reason: str) -> None:
        """Reject goals with this reason."""
        self._runner.lose(reason)

    def world_restored(self) -> None:
        """Accept goals again."""
        self._runner.find()

    async def stop(self) -> None:
        """Cancel the motions of arm and gripper; return when the arm is measured at rest.

        Raises:
            RobotError: the arm still moves, or is not reachable.
        """
        runner = self._runner
        runner.brake()
        try:
            if self._gripper is not None:
                await self._gripper.stop()
        finally:
            # The arm brakes first and is awaited, even if stopping the fingers fails.
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
            # In virtual time nobody waits for wall time, so modules load on first use.
            runner.loading.begin()
        if self._tool_changer is not None:
            self._tool_changer.begin()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            # The loss of an unreachable arm was reported when it happened; it cannot be stopped from here.
            if not self._runner.lost_reason:
                await self.stop()
        finally:
            self._runner.lost_reason = ""
            self._runner.status = DeviceStatus.DISCONNECTED
            self._runner.changed()
            if self._tool_changer is not None:
                await self._tool_changer.end()
            await self._runner.loading.close()

    def _tool_changed(self) -> None:
        self._runner.changed()
        self._describe()


def _no_operation() -> None:
    """Do nothing."""

"""Creates captures: one configuration, one pose, one frame, or a recording with the primitive learned from it."""

from __future__ import annotations

import time

import msgspec

from engine.bus import SkillBus
from engine.cause_chain import cause_of, describe_cause
from engine.errors import FlexcellError, SkillFailed
from engine.messages import FramePoses, JointState, Pose
from engine.skills.dmp import LearnCartDmp, LearnJointDmp
from engine.skills.gripper import GripperSetting, ReadGripper
from engine.skills.motion import ForwardKinematics
from engine.skills.teaching import Capture, CaptureForm, CaptureSummary, Trigger
from engine.teaching.capture_buffer import CaptureBuffer
from engine.teaching.frames import relative_pose
from engine.teaching.joint_recording import JointRecording, path_length_rad


class CaptureBuilder:
    """Reads the data of a capture from the robots and puts it into the buffer; raises FlexcellError with the reason."""

    def __init__(self, bus: SkillBus, buffer: CaptureBuffer) -> None:
        self._bus = bus
        self._buffer = buffer

    async def joints(self, trigger: Trigger, robot: str) -> Capture:
        """Capture the joint positions, with the pose of the tool as a detail."""
        state = self._joint_state(robot)
        return self._keep(
            Capture(
                summary=self._summary(trigger, robot, "joints"),
                names=state.names,
                joints=tuple(state.position_rad),
                pose=await self._pose(robot),
            )
        )

    async def pose(self, trigger: Trigger, robot: str) -> Capture:
        """Capture the pose of the tool centre point in the world, with the joint positions as a detail."""
        state = self._joint_state(robot)
        return self._keep(
            Capture(
                summary=self._summary(trigger, robot, "pose"),
                names=state.names,
                joints=tuple(state.position_rad),
                pose=await self._pose(robot),
            )
        )

    async def gripper(self, trigger: Trigger, robot: str) -> Capture:
        """Capture the opening of the gripper and whether it holds a part, with the pose of the arm."""
        state = self._joint_state(robot)
        measured = await self._bus.call(ReadGripper(), to=f"{robot}/gripper")
        force_n = measured.force_n if measured.held else 0.0
        return self._keep(
            Capture(
                summary=self._summary(trigger, robot, "gripper"),
                names=state.names,
                joints=tuple(state.position_rad),
                pose=await self._pose(robot),
                gripper=GripperSetting(width_m=max(0.0, measured.width_m), held=measured.held, force_n=force_n),
            )
        )

    async def frame(self, trigger: Trigger, robot: str) -> Capture:
        """Capture the pose of `source_frame` in `target_frame`; the default source is the tool of the robot."""
        if not trigger.source_frame:
            if not robot:
                raise SkillFailed("name a `source_frame` or a robot", where=trigger.trig_name)
            return await self.pose(trigger, robot)
        topic = self._bus.find_topic("cell/frames")
        poses = topic.latest
        if not isinstance(poses, FramePoses):
            raise SkillFailed("no frame poses are published", where=trigger.trig_name, hint="open a cell with a world")
        pose = relative_pose(poses, trigger.source_frame, trigger.target_frame)
        return self._keep(Capture(summary=self._summary(trigger, robot, "pose"), pose=pose))

    async def recorded(self, trigger: Trigger, recording: JointRecording) -> Capture:
        """Capture a recording that ends now, and learn the primitive that the trigger requests.

        If learning fails, the recording is kept, with the reason as its remark.
        """
        trajectory = recording.end()
        cartesian = trigger.trig_callback == "cart_dmp_save"
        form: CaptureForm = "cart_dmp" if cartesian else "dmp"
        summary = msgspec.structs.replace(
            self._summary(trigger, recording.robot, form),
            samples=len(trajectory.times_s),
            duration_s=trajectory.times_s[-1],
            length_rad=path_length_rad(trajectory),
            peak_rad_s=recording.peak_rad_s,
        )
        last = trajectory.joints[-1]
        whole = Capture(summary=summary, names=trajectory.names, joints=last, trajectory=trajectory)
        try:
            if cartesian:
                cart = await self._bus.call(
                    LearnCartDmp(trajectory=trajectory, N=trigger.joint_dmp_N), to=recording.robot
                )
                whole = msgspec.structs.replace(whole, cart_dmp=cart.dmp, cart_fit=cart.fit)
            else:
                joint = await self._bus.call(
                    LearnJointDmp(trajectory=trajectory, N=trigger.joint_dmp_N), to=recording.robot
                )
                whole = msgspec.structs.replace(whole, joint_dmp=joint.dmp, joint_fit=joint.fit)
            whole = msgspec.structs.replace(whole, pose=await self._pose(recording.robot, last))
        except FlexcellError as error:
            # The demonstration is kept: the primitive can be learned from it later.
            kept = msgspec.structs.replace(summary, form="trajectory", remark=describe_cause(cause_of(error)))
            whole = msgspec.structs.replace(whole, summary=kept)
        return self._keep(whole)

    def _joint_state(self, robot: str) -> JointState:
        state = self._bus.find_topic(f"{robot}/joint_state").latest
        if not isinstance(state, JointState):
            raise SkillFailed("the robot has not published joint states yet", where=robot, hint="connect it first")
        return state

    async def _pose(self, robot: str, joints: tuple[float, ...] = ()) -> Pose:
        return await self._bus.call(ForwardKinematics(joints=joints), to=robot)

    def _summary(self, trigger: Trigger, robot: str, form: CaptureForm) -> CaptureSummary:
        return CaptureSummary(
            id=self._buffer.next_id(), taken_at_s=time.time(), trigger=trigger.trig_name, robot=robot, form=form
        )

    def _keep(self, capture: Capture) -> Capture:
        self._buffer.put(capture)
        return capture

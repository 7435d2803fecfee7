"""What a world tells on the bus, at which rate: scene, frames, parts, joints, grippers.

Latest values are made on demand, streams only while somebody subscribes.
"""

from __future__ import annotations

from collections.abc import Callable

from engine.bus import SkillBus, Topic
from engine.messages import FramePoses, GripperState, JointState, PartPoses, Pose, SceneDescription
from robots.sim.host import Host
from robots.sim.snapshot import ArmSummary, Snapshot

FRAME_RATE_HZ = 30.0
JOINT_RATE_HZ = 100.0
# Both pads press at least this hard on the same part before it counts as held.
_HELD_N = 1.0


class WorldPublisher:
    """Publishes the state of one world on one bus."""

    def __init__(self, bus: SkillBus, host: Host, describe: Callable[[], SceneDescription]) -> None:
        self._host = host
        summary = host.summary
        self._frames = summary.frames
        self._parts = frozenset(summary.parts)
        self._part_rows = [(row, name) for row, name in enumerate(summary.frames) if name in self._parts]
        self._fast = tuple(self._arm_topics(bus, arm) for arm in summary.arms)
        self._frame_topic = bus.topic("cell/frames", FramePoses)
        self._part_topic = bus.topic("cell/parts", PartPoses)
        self._frame_topic.provide(lambda: self._frame_poses(host.snapshot()))
        self._part_topic.provide(lambda: self._part_poses(host.snapshot()))
        bus.topic("cell/scene", SceneDescription).publish(describe())

    @property
    def read(self) -> bool:
        """True while somebody subscribes to anything that changes."""
        slow = self._frame_topic.subscriber_count + self._part_topic.subscriber_count
        return slow > 0 or any(j.subscriber_count + g.subscriber_count for j, g, _ in self._fast)

    def publish_joints(self) -> bool:
        """Publish joints and grippers to who subscribes; true if anybody did."""
        if not any(j.subscriber_count + g.subscriber_count for j, g, _ in self._fast):
            return False
        snapshot = self._host.snapshot()
        for joints, gripper, arm in self._fast:
            if joints.subscriber_count:
                joints.publish(_joint_state(snapshot, arm))
            if gripper.subscriber_count:
                gripper.publish(self._gripper_state(snapshot, arm))
        return True

    def publish_frames(self) -> bool:
        """Publish frames and parts to who subscribes; true if anybody did."""
        frames, parts = self._frame_topic.subscriber_count > 0, self._part_topic.subscriber_count > 0
        if not (frames or parts):
            return False
        snapshot = self._host.snapshot()
        if frames:
            self._frame_topic.publish(self._frame_poses(snapshot))
        if parts:
            self._part_topic.publish(self._part_poses(snapshot))
        return True

    def _arm_topics(self, bus: SkillBus, arm: ArmSummary) -> tuple[Topic[JointState], Topic[GripperState], ArmSummary]:
        joints = bus.topic(f"{arm.name}/joint_state", JointState)
        gripper = bus.topic(f"{arm.name}/gripper/state", GripperState)
        joints.provide(lambda: _joint_state(self._host.snapshot(), arm))
        gripper.provide(lambda: self._gripper_state(self._host.snapshot(), arm))
        return joints, gripper, arm

    def _frame_poses(self, snapshot: Snapshot) -> FramePoses:
        xyz, xyzw = snapshot.frames()
        return FramePoses(time_s=snapshot.time_s, names=self._frames, xyz=xyz, xyzw=xyzw)

    def _part_poses(self, snapshot: Snapshot) -> PartPoses:
        xyz, xyzw = snapshot.frames()
        poses = {name: Pose(xyz=xyz[row], xyzw=xyzw[row]) for row, name in self._part_rows}
        return PartPoses(time_s=snapshot.time_s, poses=poses)

    def _gripper_state(self, snapshot: Snapshot, arm: ArmSummary) -> GripperState:
        sample = snapshot.gripper(arm.name)
        left, right = sample.contacts
        return GripperState(
            time_s=sample.time_s,
            width_m=sample.width_m,
            force_n=sample.force_n,
            held=left == right and left in self._parts and sample.force_n >= _HELD_N,
        )


def _joint_state(snapshot: Snapshot, arm: ArmSummary) -> JointState:
    sample = snapshot.arm(arm.name)
    return JointState(
        time_s=sample.time_s,
        names=arm.joints,
        position_rad=tuple(sample.position_rad.tolist()),
        velocity_rad_s=tuple(sample.velocity_rad_s.tolist()),
        effort_nm=tuple(sample.effort_nm.tolist()),
    )

"""The topics of a world and their rates: scene, frames, parts, joints, forces, tools.

Latest values are computed on demand, streams only while they have subscribers.
"""

from __future__ import annotations

from collections.abc import Callable

from engine.bus import SkillBus
from engine.messages import FramePoses, PartPoses, Pose, SceneDescription, Vector3
from engine.messages.bonds import BONDS_TOPIC, BondState, CellBonds
from robots.scene.sim_scene import SimScene
from robots.scene.up_axis import up_axis
from robots.sim.host.world_host import WorldHost
from robots.sim.loop.bond_reading import joined_bodies
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.hexapod_drawing import leg_frames
from robots.sim.world.arm_topics import arm_topics
from robots.sim.world.tool_topics import tool_topic

FRAME_RATE_HZ = 30.0
JOINT_RATE_HZ = 100.0
_USUALLY_UP: Vector3 = (0.0, 0.0, 1.0)
"""The axis of parts that `PartPoses` does not list."""


class WorldPublisher:
    """Publishes the state of one world on one bus."""

    def __init__(
        self,
        bus: SkillBus,
        host: WorldHost,
        describe: Callable[[SimScene], SceneDescription],
        *,
        scene: SimScene,
    ) -> None:
        self._host = host
        self._describe = describe
        joint_maps = {placement.name: placement.robot().joint_map for placement in scene.arms}
        summary = host.summary
        real = {placement.name for placement in scene.arms if placement.driven}
        simulated_arms = [arm for arm in summary.arms if arm.name not in real]
        arms = tuple(topic for arm in simulated_arms for topic in arm_topics(bus, host, arm, joint_maps[arm.name]))
        driven = {placement.name for placement in scene.arms if placement.driven_tool}
        simulated = [arm for arm in summary.arms if arm.name not in driven]
        topics = (tool_topic(bus, host, arm, parts=frozenset(summary.parts)) for arm in simulated)
        self._fast = (*arms, *(topic for topic in topics if topic is not None))
        self._frame_topic = bus.topic("cell/frames", FramePoses)
        self._part_topic = bus.topic("cell/parts", PartPoses)
        self._bonds = scene.bonds
        self._bond_topic = bus.topic(BONDS_TOPIC, CellBonds) if scene.bonds else None
        if self._bond_topic is not None:
            self._bond_topic.provide(lambda: self._bond_states(host.snapshot()))
        self._frame_topic.provide(lambda: self._frame_poses(host.snapshot()))
        self._part_topic.provide(lambda: self._part_poses(host.snapshot()))
        self._scene_topic = bus.topic("cell/scene", SceneDescription)
        self.take_scene(scene)

    def take_scene(self, scene: SimScene) -> None:
        """Publish what is in the world from now on."""
        summary = self._host.summary
        self._up = {part.name: axis for part in scene.parts if (axis := up_axis(part)) != _USUALLY_UP}
        present = frozenset(part.name for part in scene.parts)
        away = frozenset(summary.parts) - present
        self._rows = [row for row, name in enumerate(summary.frames) if name not in away]
        self._bodies = tuple(summary.frames[row] for row in self._rows)
        self._named = scene.frames
        self._scene = scene if any(fixture.hexapod is not None for fixture in scene.fixtures) else SimScene()
        self._platform_rows = {
            fixture.name: summary.frames.index(fixture.name)
            for fixture in self._scene.fixtures
            if fixture.hexapod is not None
        }
        self._part_rows = [(row, name) for row, name in enumerate(summary.frames) if name in present]
        self._scene_topic.publish(self._describe(scene))
        self.publish_frames()

    def take_frames(self, frames: dict[str, Pose]) -> None:
        """Publish the named frames where they are now."""
        self._named = frames
        self.publish_frames()

    @property
    def read(self) -> bool:
        """True while any changing topic has subscribers."""
        slow = self._frame_topic.subscriber_count + self._part_topic.subscriber_count
        return slow > 0 or self._bonds_read() or self._fast_read()

    def publish_joints(self) -> bool:
        """Publish joints, forces and tools to subscribers; true if there are any."""
        if not self._fast_read():
            return False
        snapshot = self._host.snapshot()
        for topic in self._fast:
            if topic.read:
                topic.publish(snapshot)
        return True

    def publish_frames(self) -> bool:
        """Publish frames and parts to subscribers; true if there are any."""
        frames, parts = self._frame_topic.subscriber_count > 0, self._part_topic.subscriber_count > 0
        bonds = self._bonds_read()
        if not (frames or parts or bonds):
            return False
        snapshot = self._host.snapshot()
        if frames:
            self._frame_topic.publish(self._frame_poses(snapshot))
        if parts:
            self._part_topic.publish(self._part_poses(snapshot))
        if bonds and self._bond_topic is not None:
            self._bond_topic.publish(self._bond_states(snapshot))
        return True

    def _bonds_read(self) -> bool:
        return self._bond_topic is not None and self._bond_topic.subscriber_count > 0

    def _fast_read(self) -> bool:
        return any(topic.read for topic in self._fast)

    def _frame_poses(self, snapshot: SimSnapshot) -> FramePoses:
        xyz, xyzw = snapshot.frames()
        platforms = {name: Pose(xyz=xyz[row], xyzw=xyzw[row]) for name, row in self._platform_rows.items()}
        others = {**self._named, **leg_frames(self._scene, platforms)}
        return FramePoses(
            time_s=snapshot.time_s,
            names=(*self._bodies, *others),
            xyz=(*(xyz[row] for row in self._rows), *(pose.xyz for pose in others.values())),
            xyzw=(*(xyzw[row] for row in self._rows), *(pose.xyzw for pose in others.values())),
        )

    def _part_poses(self, snapshot: SimSnapshot) -> PartPoses:
        xyz, xyzw = snapshot.frames()
        poses = {name: Pose(xyz=xyz[row], xyzw=xyzw[row]) for row, name in self._part_rows}
        joined = {name: ends for name, ends in joined_bodies(self._bonds, snapshot.bonds()).items() if name in poses}
        return PartPoses(time_s=snapshot.time_s, poses=poses, up=self._up, joined=joined)

    def _bond_states(self, snapshot: SimSnapshot) -> CellBonds:
        readings = snapshot.bonds()
        states = {
            name: BondState(
                kind=bond.kind,
                part=bond.part,
                to=bond.to,
                broken_by=readings[name].broken_by,
                force_n=round(readings[name].force_n, 3),
                torque_nm=round(readings[name].torque_nm, 4),
            )
            for name, bond in self._bonds.items()
        }
        return CellBonds(time_s=snapshot.time_s, bonds=states)

"""Tests that arms, what they hold and known things never show in the map, wherever they are and move."""

from __future__ import annotations

import numpy as np
import pytest

from engine.document.cell_perception import DepthCamera, OccupancyMap
from engine.errors import CellError
from engine.messages import Pose
from engine.messages.shapes import Box, Solid
from robots.model.transform import RigidTransform
from robots.planning.scene.cell_planning_scene import known_obstacles
from robots.planning.scene.planning_scene import AttachedPart
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement, PartBody, SimScene
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import build_cell
from robots.vision.camera_rig import CameraRig
from robots.vision.known_geometry import ArmConfiguration, KnownGeometry, MeasuredState
from robots.vision.occupancy.arm_body import ArmBody
from robots.vision.occupancy.occupancy_mapper import OccupancyMapper
from robots.vision.perception_messages import PerceptionRequest
from robots.vision.voxel_box import voxel_box
from tests.robots.vision.watched_cell import PANDA, block, cameras, look, perception_setup, scene, voxels

ROOM = voxel_box(OccupancyMap(center_m=(0.0, 0.0, 1.1), size_m=(4.0, 4.0, 2.4), voxel_m=0.02))
AROUND = cameras(
    front=DepthCamera(at=(3.2, 0.0, 2.5), look_at=(0.0, 0.0, 0.8), range_m=(0.2, 8.0)),
    side=DepthCamera(at=(-1.0, 3.4, 2.6), look_at=(0.0, 0.0, 0.8), range_m=(0.2, 8.0)),
)
ARMS = {
    "panda": PANDA,
    "ur10 with a linkage": ArmPlacement(name="arm", model="ur10", base=PANDA.base, gripper="robotiq_2f85"),
    "irb4600 with a magnet": ArmPlacement(name="arm", model="irb4600", base=PANDA.base, gripper="magnet"),
    "ur10 with a hand": ArmPlacement(name="arm", model="ur10", base=PANDA.base, gripper="softhand"),
}


class Stage:
    """A simulated cell whose arm and parts are put where the test wants them, and an eye on it."""

    def __init__(self, what: SimScene, *, names: tuple[str, ...] = ("front", "side")) -> None:
        self.cell = build_cell(what)
        self._names = names
        self._simulation = Simulation(self.cell)
        self._q: Array = self._simulation._physics.positions  # pyright: ignore[reportPrivateUsage]
        self.eye = CameraRig(perception_setup(what, *AROUND, box=ROOM), repeatable=True)

    def see(self, joints: Array, *, part: Pose | None = None) -> Array:
        """Return the voxels after a look with the arm at these joints."""
        self._q[self.cell.arms[0].qpos] = joints
        if part is not None:
            x, y, z, w = part.xyzw
            self._q[self.cell.part_qpos] = [*part.xyz, w, x, y, z]
        image = np.zeros(self._simulation.image_layout.size)
        self._simulation.write_image(image)
        return voxels(self.eye.look(PerceptionRequest(time_s=0.0, state=image, cameras=self._names)).grid)


def postures(arm: ArmPlacement, count: int) -> Array:
    """Return random joints within the limits, (count, n)."""
    limits = arm.robot().limits
    low, high = np.maximum(limits.lower_rad, -np.pi), np.minimum(limits.upper_rad, np.pi)
    return np.random.default_rng(7).uniform(low, high, size=(count, len(low)))


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_leaves_no_voxel_anywhere_it_can_be(name: str) -> None:
    arm = ARMS[name]
    stage = Stage(scene(arms=(arm,)))
    assert [len(stage.see(joints)) for joints in postures(arm, 12)] == [0] * 12


def test_a_moving_arm_leaves_no_voxels_behind_and_does_not_wipe_away_what_it_passes() -> None:
    pillar = block((0.6, 0.6, 0.5), (0.1, 0.1, 1.0), name="pillar")
    stage = Stage(scene(pillar, arms=(PANDA,)))
    # The map knows the floor alone.
    stage.eye.know(KnownGeometry(obstacles=known_obstacles(scene())))
    home = np.array(PANDA.robot().home_rad)
    for _ in range(5):
        stage.see(home)
    there = {tuple(p) for p in stage.see(home).round(2).tolist()}
    assert len(there) > 300
    for turn in np.linspace(0.0, -1.5, 20):
        seen = stage.see(home + np.array([turn, *(0.0,) * 6]))
        assert np.abs(seen[:, :2] - 0.6).max() < 0.05 + ROOM.voxel_m
        assert there <= {tuple(p) for p in seen.round(2).tolist()}


def test_what_was_seen_before_an_arm_came_beside_it_is_not_taken_for_the_arm() -> None:
    """A rod 2 cm from the hand: within the margin, where nothing new would be seen."""
    home = np.array(PANDA.robot().home_rad)
    away = home + np.array([1.2, *(0.0,) * 6])
    balls = ArmBody(PANDA).balls(ArmConfiguration(joints=tuple(home.tolist())))
    outermost = balls[np.argmax(balls[:, 0] + balls[:, 3])]
    x = float(outermost[0] + outermost[3]) + 0.04
    rod = block((x, float(outermost[1]), float(outermost[2])), (0.04, 0.1, 0.2), name="rod")
    stage = Stage(scene(rod, arms=(PANDA,)))
    stage.eye.know(KnownGeometry(obstacles=known_obstacles(scene())))
    before = [stage.see(away) for _ in range(3)][-1]
    assert len(before) > 30
    beside = [stage.see(home) for _ in range(5)][-1]
    assert {tuple(p) for p in before.round(2).tolist()} <= {tuple(p) for p in beside.round(2).tolist()}


def test_a_part_in_a_hand_leaves_no_voxel_while_it_moves_along() -> None:
    size = (0.3, 0.3, 0.05)
    shape, offset = Box(size_m=size), np.array([0.0, 0.0, 0.1])
    part = PartBody(name="plate", shape="box", size_m=size, mass_kg=1.0, pose=Pose(xyz=(0.0, 0.0, 5.0)))
    body, home = ArmBody(PANDA), np.array(PANDA.robot().home_rad)

    def left(*held: AttachedPart) -> int:
        stage = Stage(scene(arms=(PANDA,), parts=(part,)))
        stage.eye.know(KnownGeometry(obstacles=known_obstacles(scene()), held=held))
        found = 0
        for turn in np.linspace(0.0, 1.0, 8):
            joints = home + np.array([turn, *(0.0,) * 6])
            hand = body.link_pose(ArmConfiguration(joints=tuple(joints.tolist())), body.tool_link)
            carried = RigidTransform(xyz=hand.xyz + hand.rotation @ offset, xyzw=hand.xyzw).to_pose("world")
            found += len(stage.see(joints, part=carried))
        return found

    solid = Solid(shape=shape)
    assert left(AttachedPart(name="plate", arm="arm", solids=(solid,), pose=Pose(xyz=(0.0, 0.0, 0.1)))) == 0
    # Had nobody said that it is held, it would be in the way.
    assert left() > 500


def test_a_held_part_that_is_not_measured_is_where_the_arm_has_it() -> None:
    mapper = OccupancyMapper(ROOM, (PANDA,))
    size = (0.3, 0.3, 0.3)
    held = AttachedPart(
        name="plate", arm="arm", solids=(Solid(shape=Box(size_m=size)),), pose=Pose(xyz=(0.0, 0.0, 0.3))
    )
    home = ArmConfiguration(joints=PANDA.robot().home_rad)
    at = ArmBody(PANDA).link_pose(home, PANDA.robot().tool_link)
    x, y, z = (at.xyz + at.rotation @ np.array([0.0, 0.0, 0.3])).tolist()
    what = scene(block((x, y, z), (0.2, 0.2, 0.2)))
    stage = CameraRig(perception_setup(what, *AROUND, box=ROOM), repeatable=True)
    images = stage.look(look(what, ("front", "side"))).images
    moment = MeasuredState(time_s=0.0, arms={"arm": home})
    mapper.know(KnownGeometry(obstacles=known_obstacles(scene())))
    assert len(voxels(mapper.update(images, moment))) > 50
    mapper.know(KnownGeometry(obstacles=known_obstacles(scene()), held=(held,)))
    assert len(voxels(mapper.update(images, moment))) == 0


def test_a_part_that_was_pushed_is_known_where_it_lies_now() -> None:
    part = PartBody(name="box", shape="box", size_m=(0.1, 0.1, 0.1), mass_kg=1.0, pose=Pose(xyz=(0.8, 0.0, 0.05)))
    stage = Stage(scene(arms=(PANDA,), parts=(part,)))
    home = np.array(PANDA.robot().home_rad)
    for y in (0.0, 0.1, 0.4, -0.4):
        assert len(stage.see(home, part=Pose(xyz=(0.8, y, 0.05)))) == 0


def test_a_posture_of_another_arm_is_refused() -> None:
    mapper = OccupancyMapper(ROOM, (PANDA,))
    for arms in ({"arm": ArmConfiguration(joints=(0.0,))}, {"other": ArmConfiguration(joints=PANDA.robot().home_rad)}):
        with pytest.raises(CellError):
            mapper.update([], MeasuredState(time_s=0.0, arms=arms))
    strange = ArmConfiguration(joints=PANDA.robot().home_rad, tool_joints={"nose": 0.0})
    with pytest.raises(CellError, match="no joint nose"):
        mapper.update([], MeasuredState(time_s=0.0, arms={"arm": strange}))

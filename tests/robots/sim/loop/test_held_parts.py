"""Parts in tools with drivers: they follow the tool that reports to hold something, and are free afterwards."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import PartBody
from robots.sim.commands.world_commands import MirrorArm, MirrorPart, MirrorTool, RestoreWorld
from robots.sim.loop.held_parts import gap_m
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from tests.robots.sim.sim_cell import HOME, RIGHT, box, one_arm

REST = np.zeros(7)


def simulation(*, at: Array | None = None, gravity: bool = False) -> Simulation:
    """Return a world with a driven arm, and a cube at the middle of its hand, or at a point."""
    driven = replace(RIGHT, driven=True, driven_tool=True)
    scene = one_arm(box("cube"))
    empty = Simulation(build_cell(replace(scene, arms=(*scene.arms, driven), gravity=False)))
    tool = frame(empty, f"right/{driven.robot().tool_link}")
    pose = Pose(xyz=tuple((tool.xyz if at is None else at).tolist()))
    cube = replace(box("cube"), pose=pose, size_m=(0.02, 0.02, 0.02))
    return Simulation(build_cell(replace(scene, arms=(*scene.arms, driven), parts=(cube,), gravity=gravity)))


def frame(world: Simulation, name: str) -> RigidTransform:
    values = world.layout.new_array()
    world.write_snapshot(values)
    xyz, xyzw = SimSnapshot(world.layout, values).frames()
    row = world.summary.frames.index(name)
    return RigidTransform.of(xyz[row], xyzw[row])


def moved(world: Simulation, joints: Array) -> RigidTransform:
    """Measure the arm elsewhere, and return where the cube is then."""
    world.apply(MirrorArm(arm="right", position_rad=joints, velocity_rad_s=REST))
    for _ in range(5):
        world.step()
    return frame(world, "cube")


def held(world: Simulation) -> str:
    values = world.layout.new_array()
    world.write_snapshot(values)
    return SimSnapshot(world.layout, values).held_part("right")


def in_hand(world: Simulation) -> RigidTransform:
    link = frame(world, f"right/{RIGHT.robot().tool_link}")
    return link.inverse().then(frame(world, "cube"))


def test_a_part_follows_the_tool_that_holds_it_and_stays_where_it_is_let_go() -> None:
    world = simulation()
    world.step()
    world.apply(MirrorTool(arm="right", held=True))
    taken = in_hand(world)
    there = moved(world, HOME + 0.2)
    assert in_hand(world).distance_m(taken) < 1e-6
    assert in_hand(world).angle_rad(taken) < 1e-6
    assert held(world) == "cube"
    world.apply(MirrorTool(arm="right", held=True))
    world.apply(MirrorTool(arm="right", held=False))
    assert moved(world, HOME).distance_m(there) < 0.001
    assert held(world) == ""


def test_a_tool_that_holds_something_else_takes_no_part_along() -> None:
    """Also not one that it passes later: only the beginning of a hold takes a part."""
    world = simulation(at=np.array([0.0, 3.0, 0.5]))
    world.step()
    world.apply(MirrorTool(arm="right", held=True))
    before = frame(world, "cube")
    assert moved(world, HOME + 0.2).distance_m(before) < 1e-6


def test_a_held_part_stays_in_the_hand_when_the_world_is_restored() -> None:
    """The tool reports twenty times a second: until then the part would fall, by a centimetre each time."""
    world = simulation(gravity=True)
    world.step()
    world.apply(MirrorTool(arm="right", held=True))
    moved(world, HOME)
    image = np.zeros(world.image_layout.size)
    world.write_image(image)
    before = in_hand(world)
    world.apply(RestoreWorld(image=image))
    assert held(world) == "cube"
    for _ in range(50):
        world.step()
    # What gravity adds in one step.
    assert in_hand(world).distance_m(before) < 2e-5
    world.apply(MirrorTool(arm="right", held=False))
    assert held(world) == ""


def test_a_part_of_another_world_is_where_that_has_it_and_falls_when_it_is_free() -> None:
    world = simulation(gravity=True)
    there = Pose(xyz=(0.4, 0.5, 0.6), xyzw=(0.0, 0.0, 0.6, 0.8))
    world.apply(MirrorPart(part="cube", pose=there))
    for _ in range(50):
        world.step()
    # What gravity adds in one step.
    assert frame(world, "cube").distance_m(RigidTransform.from_pose(there)) < 2e-5
    assert frame(world, "cube").angle_rad(RigidTransform.from_pose(there)) < 1e-6
    world.apply(MirrorPart(part="cube", pose=None))
    for _ in range(50):
        world.step()
    assert frame(world, "cube").xyz[2] < 0.595


@pytest.mark.parametrize(
    ("shape", "size_m", "point", "gap"),
    [
        ("box", (0.2, 0.4, 0.6), (1.0, 0.0, 0.5), 0.2),
        ("box", (0.2, 0.4, 0.6), (1.1, 0.0, 0.1), 0.0),
        ("cylinder", (0.2, 0.4), (1.13, 0.0, 0.24), 0.05),
        ("sphere", (0.2,), (1.0, 0.3, 0.0), 0.2),
    ],
)
def test_the_gap_is_that_to_the_surface(
    shape: str, size_m: tuple[float, ...], point: tuple[float, float, float], gap: float
) -> None:
    part = PartBody(name="part", shape=shape, size_m=size_m, mass_kg=1.0, pose=Pose(xyz=(1.0, 0.0, 0.0)))
    assert gap_m(part, RigidTransform.from_pose(part.pose), np.array(point)) == pytest.approx(gap)

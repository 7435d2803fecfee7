"""The body of an arm with a driver in a simulated world: where its driver measures it, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from robots.control.commanding.arm_commands import FollowTrajectory
from robots.port import Tolerance
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import MirrorArm
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from tests.robots.sim.sim_cell import HOME, RIGHT, box, one_arm, smooth

ELSEWHERE = HOME + 0.2


def simulation() -> Simulation:
    """Return a world with a simulated and a driven arm."""
    scene: SimScene = one_arm(box("cube"))
    return Simulation(build_cell(replace(scene, arms=(*scene.arms, replace(RIGHT, driven=True, driven_tool=True)))))


def measured(world: Simulation) -> SimSnapshot:
    values = world.layout.new_array()
    world.write_snapshot(values)
    return SimSnapshot(world.layout, values)


def test_a_driven_arm_stands_where_it_is_measured() -> None:
    world = simulation()
    speed = np.full(7, 0.1)
    world.apply(MirrorArm(arm="right", position_rad=ELSEWHERE, velocity_rad_s=speed))
    before = measured(world).frames()[0]
    for _ in range(50):
        assert world.step() == []
    sample = measured(world).arm("right")
    assert sample.position_rad == pytest.approx(ELSEWHERE)
    assert sample.velocity_rad_s == pytest.approx(speed)
    frames = world.summary.frames
    hand = frames.index("right/panda_hand")
    after = measured(world).frames()[0]
    assert np.linalg.norm(np.subtract(after[hand], before[hand])) > 0.05
    # It is not held by motors, and gravity does not move it.
    for _ in range(500):
        world.step()
    assert measured(world).frames()[0][hand] == pytest.approx(after[hand], abs=1e-3)


def test_the_rest_of_a_world_does_not_depend_on_the_motion_of_a_driven_arm() -> None:
    world = simulation()
    world.apply(MirrorArm(arm="right", position_rad=ELSEWHERE, velocity_rad_s=np.full(7, 1.0)))
    for _ in range(200):
        world.step()
    assert world.at_rest


def test_the_other_arm_moves_as_ever() -> None:
    world = simulation()
    trajectory = smooth(HOME, HOME + 0.1, 0.3)
    world.apply(FollowTrajectory(arm="left", motion=1, trajectory=trajectory, tolerance=Tolerance()))
    for _ in range(2000):
        world.step()
    assert measured(world).arm("left").position_rad == pytest.approx(HOME + 0.1, abs=0.02)
    assert measured(world).arm("right").position_rad == pytest.approx(HOME)

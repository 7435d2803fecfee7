"""The judge of planned motions finds what is known to touch, and nothing where nothing is."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, box
from engine.messages import Pose
from engine.messages.shapes import Box, Capsule, Cylinder, Obstacle, Shape, Solid, Sphere
from robots.model.registry import robot_model
from robots.planning.scene.planning_scene import AttachedPart
from tests.robots.planning.motion_oracle import STEP_RAD, MotionOracle, fine_steps

HOME = np.array(robot_model("panda").home_rad)
LEFT, RIGHT = (np.array([turn, *HOME[1:]]) for turn in (-1.2, 1.2))
SWEEP = np.vstack((LEFT, RIGHT))


def test_a_free_motion_is_free() -> None:
    assert MotionOracle(alone("panda"), ARM).first_touch(SWEEP) is None


@pytest.mark.parametrize(
    "shape",
    [
        Box(size_m=(0.3, 0.01, 0.6)),
        Cylinder(radius_m=0.005, length_m=0.6),
        Capsule(radius_m=0.005, length_m=0.6),
        Sphere(radius_m=0.1),
    ],
)
def test_something_thin_in_the_sweep_is_touched_and_named(shape: Shape) -> None:
    scene = alone("panda").with_obstacles(Obstacle.of("thin", shape, Pose(xyz=(0.32, 0.0, 0.6))))
    touch = MotionOracle(scene, ARM).first_touch(SWEEP)
    assert touch is not None
    assert "thin" in touch.bodies
    assert touch.distance_m < 0.0
    assert MotionOracle(scene.with_allowed(ARM, "thin"), ARM).first_touch(SWEEP) is None


def test_the_margin_counts_for_obstacles_and_not_for_the_arm_itself() -> None:
    scene = alone("panda").with_obstacles(box("wall", (0.02, 2.0, 2.0), (0.85, 0.0, 0.6)))
    assert MotionOracle(scene, ARM).first_touch(SWEEP) is None
    near = MotionOracle(scene, ARM, margin_m=0.5)
    touch = near.first_touch(SWEEP)
    assert touch is not None
    assert "wall" in touch.bodies
    assert near.gap_m(HOME) == pytest.approx(near.touches(HOME)[0].distance_m)


def test_a_held_part_touches_what_the_bare_arm_does_not() -> None:
    scene = alone("panda").with_obstacles(box("table", (0.3, 2.0, 0.02), (0.45, 0.0, 0.1)))
    stick = Solid(shape=Box(size_m=(0.02, 0.02, 0.4)), pose=Pose(xyz=(0.0, 0.0, 0.25)))
    held = scene.with_attached(AttachedPart(name="stick", arm=ARM, solids=(stick,)))
    assert MotionOracle(scene, ARM).first_touch(SWEEP) is None
    touch = MotionOracle(held, ARM).first_touch(SWEEP)
    assert touch is not None
    assert set(touch.bodies) == {"stick", "table"}


def test_an_arm_that_touches_itself_is_found() -> None:
    folded = np.array([0.0, 1.2, 0.0, -3.0, 0.0, 0.1, 0.0])
    touch = MotionOracle(alone("panda"), ARM).first_touch(np.vstack((HOME, folded)))
    assert touch is not None
    assert all(body.startswith(f"{ARM}/") for body in touch.bodies)


def test_steps_are_fine_and_keep_the_waypoints() -> None:
    path = np.vstack((LEFT, HOME, RIGHT))
    rows = fine_steps(path)
    assert float(np.abs(np.diff(rows, axis=0)).sum(axis=1).max()) <= STEP_RAD + 1e-12
    assert all(any(np.array_equal(row, waypoint) for row in rows) for waypoint in path)

"""The body of an arm that is nearest to the occupied voxels, against a search through all pairs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.messages import Pose
from engine.messages.shapes import Box, Solid
from robots.model.transform import RigidTransform
from robots.planning.scene.planning_scene import AttachedPart
from robots.port import Array
from robots.workspace.separation_measurement import NearestBody, nearest_body

HERE = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def _balls(random: np.random.Generator, count: int) -> Array:
    return np.column_stack((random.uniform(-1.0, 1.0, (count, 3)), random.uniform(0.02, 0.2, count)))


def _searched(balls: dict[str, Array], points: Array) -> NearestBody:
    gaps = [
        (float(np.linalg.norm(point - ball[:3]) - ball[3]), link, row)
        for link, all_balls in balls.items()
        for ball in all_balls
        for row, point in enumerate(points)
    ]
    gap_m, link, row = min(gaps)
    x, y, z = points[row].tolist()
    return NearestBody(distance_m=gap_m, body=f"arm/{link}", at_m=(x, y, z))


@pytest.mark.parametrize("seed", range(12))
def test_the_nearest_of_all_pairs_is_found(seed: int) -> None:
    """In every other one a point is within a ball, so that its distance is negative."""
    random = np.random.default_rng(seed)
    balls = {"upper": _balls(random, 7), "lower": _balls(random, 1 + seed)}
    points = random.uniform(-2.0, 2.0, (30, 3))
    if is_inside := seed % 2 == 1:
        points[17] = balls["lower"][0, :3] + 0.01
    found, expected = nearest_body("arm", balls, (), points), _searched(balls, points)
    assert (found.body, found.at_m) == (expected.body, expected.at_m)
    assert found.distance_m == pytest.approx(expected.distance_m, abs=1e-12)
    assert not is_inside or found.distance_m < 0.0


def test_a_held_part_that_is_nearer_than_the_arm_is_named() -> None:
    ball = np.array([[0.0, 0.0, 0.0, 0.1]])
    pose = Pose(xyz=(0.5, 0.0, 0.0), frame="tool")
    part = AttachedPart(name="plate", arm="arm", solids=(Solid(shape=Box(size_m=(0.2, 0.2, 0.2))),), pose=pose)
    point = np.array([[1.0, 0.0, 0.0]])
    near = nearest_body("arm", {"hand": ball}, [(part, HERE)], point)
    assert near.body == "plate"
    assert near.distance_m == pytest.approx(0.4)
    assert nearest_body("arm", {"hand": ball}, (), point).distance_m == pytest.approx(0.9)


def test_without_occupied_voxels_nobody_is_near() -> None:
    assert nearest_body("arm", {"hand": np.array([[0.0, 0.0, 0.0, 0.1]])}, (), np.empty((0, 3))) == NearestBody()
    assert math.isinf(NearestBody().distance_m)

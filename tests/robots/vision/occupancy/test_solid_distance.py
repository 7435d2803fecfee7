"""Tests of distances to convex shapes against the nearest of many points of their surface."""

from __future__ import annotations

import numpy as np
import pytest

from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere
from robots.planning.scene.convex_shapes import convex_solid
from robots.vision.occupancy.solid_distance import solid_distance

CORNERS = tuple((float(x), float(y), float(z)) for x in (0, 1) for y in (0, 1) for z in (0, 1))


@pytest.mark.parametrize(
    "shape",
    [
        Box(size_m=(0.4, 0.6, 0.2)),
        Cylinder(radius_m=0.2, length_m=0.5),
        Sphere(radius_m=0.3),
        Capsule(radius_m=0.1, length_m=0.4),
    ],
)
def test_the_distance_is_that_of_the_nearest_point_of_the_surface(shape: Shape) -> None:
    solid = convex_solid(shape)
    points = np.random.default_rng(0).uniform(-0.8, 0.8, size=(200, 3))
    surface = solid.surface(0.01)
    nearest = np.linalg.norm(points[:, None] - surface[None], axis=2).min(axis=1)
    found = solid_distance(solid, points)
    assert np.abs(found) == pytest.approx(nearest, abs=0.01)
    assert (found < 0.0).tolist() == (solid.depth(points) > 0.0).tolist()


def test_the_distance_of_a_hull_is_never_more_than_it_is() -> None:
    solid = convex_solid(Hull(points_m=CORNERS))
    points = np.random.default_rng(0).uniform(-1.0, 2.0, size=(200, 3))
    exact = solid_distance(convex_solid(Box(size_m=(1.0, 1.0, 1.0))), points - 0.5)
    found = solid_distance(solid, points)
    assert (found <= exact + 1e-9).all()
    assert ((found < 0.0) == (exact < 0.0)).all()

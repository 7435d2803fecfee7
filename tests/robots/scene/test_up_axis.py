"""Which axis of a part points up is read from where the cell document places it."""

from __future__ import annotations

import math

import pytest

from engine.messages import Pose, Quaternion, Vector3
from robots.scene.sim_scene import PartBody
from robots.scene.up_axis import up_axis

HALF = math.sqrt(0.5)
STANDING: Quaternion = (0.0, 0.0, 0.0, 1.0)
ON_ITS_SIDE: Quaternion = (HALF, 0.0, 0.0, HALF)
LEANING: Quaternion = (math.sin(0.2), 0.0, 0.0, math.cos(0.2))
UPSIDE_DOWN: Quaternion = (1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("shape", "xyzw", "axis"),
    [
        ("box", STANDING, (0, 0, 1)),
        ("box", LEANING, (0, 0, 1)),
        ("box", ON_ITS_SIDE, (0, 1, 0)),
        ("box", UPSIDE_DOWN, (0, 0, -1)),
        ("cylinder", STANDING, (0, 0, 1)),
        ("cylinder", ON_ITS_SIDE, None),
        ("sphere", STANDING, None),
    ],
)
def test_the_axis_nearest_to_the_vertical_points_up(shape: str, xyzw: Quaternion, axis: Vector3 | None) -> None:
    """A lying cylinder may roll, a ball too."""
    pose = Pose(xyz=(0.0, 0.0, 0.0), xyzw=xyzw)
    assert up_axis(PartBody(name="part", shape=shape, size_m=(0.1, 0.1), mass_kg=1.0, pose=pose)) == axis

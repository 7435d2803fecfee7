"""A light barrier: what is in its beam interrupts it, whatever its shape and wherever its body stands."""

from __future__ import annotations

import math

import pytest

from engine.document import LightBarrier
from engine.messages import Pose
from robots.devices.light_barrier import is_interrupted
from robots.model.transform import RigidTransform
from robots.scene.sim_scene import PartBody

BEAM = LightBarrier(body="belt", start_m=(-0.1, 0.0, 0.05), end_m=(0.1, 0.0, 0.05))
TURNED = RigidTransform.from_pose(Pose(xyz=(1.0, 2.0, 0.0), xyzw=(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))))
"""Here the beam goes from (1, 1.9, 0.05) to (1, 2.1, 0.05)."""


@pytest.mark.parametrize(
    ("shape", "size_m", "xyz", "interrupted"),
    [
        ("box", (0.04, 0.04, 0.1), (1.0, 2.08, 0.05), True),
        ("box", (0.04, 0.04, 0.1), (1.03, 2.0, 0.05), False),
        ("box", (0.04, 0.04, 0.1), (1.0, 2.13, 0.05), False),
        ("box", (0.04, 0.04, 0.08), (1.0, 2.0, 0.0), False),
        ("cylinder", (0.04, 0.1), (1.019, 2.0, 0.05), True),
        ("cylinder", (0.04, 0.1), (1.019, 2.0, 0.11), False),
        ("sphere", (0.04,), (1.0, 2.0, 0.069), True),
        ("sphere", (0.04,), (1.0, 2.0, 0.071), False),
    ],
)
def test_what_is_in_the_beam_interrupts_it(
    shape: str, size_m: tuple[float, ...], xyz: tuple[float, float, float], interrupted: bool
) -> None:
    pose = Pose(xyz=xyz)
    part = PartBody(name="part", shape=shape, size_m=size_m, mass_kg=0.1, pose=pose)
    assert is_interrupted(BEAM, TURNED, [(part, RigidTransform.from_pose(pose))]) is interrupted


def test_without_parts_the_beam_is_free() -> None:
    assert not is_interrupted(BEAM, TURNED, [])

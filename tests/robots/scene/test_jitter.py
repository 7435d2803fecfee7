"""Displacement from a seed: within its bounds, repeatable, independent from part to part."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from engine.messages import Pose
from robots.scene.jitter import jitter_pose

AT = Pose(xyz=(0.1, -0.2, 0.3))


@given(st.integers(0, 2**31), st.text(min_size=1, max_size=20), st.floats(0.0, 0.1), st.floats(0.0, 3.0))
def test_parts_stay_within_their_jitter_and_upright(seed: int, name: str, xy_m: float, yaw_rad: float) -> None:
    pose = jitter_pose(AT, name=name, seed=seed, xy_m=xy_m, yaw_rad=yaw_rad)
    assert abs(pose.xyz[0] - 0.1) <= xy_m + 1e-12
    assert abs(pose.xyz[1] + 0.2) <= xy_m + 1e-12
    assert pose.xyz[2] == 0.3
    x, y, z, w = pose.xyzw
    assert x == y == 0.0
    assert abs(2 * math.atan2(z, w)) <= yaw_rad + 1e-12


def test_the_same_seed_and_name_give_the_same_pose_and_others_another() -> None:
    def draw(name: str, seed: int) -> Pose:
        return jitter_pose(AT, name=name, seed=seed, xy_m=0.015, yaw_rad=0.3)

    assert draw("a", 7) == draw("a", 7)
    assert len({draw(name, seed).xyz for name in ("a", "b") for seed in (7, 8)}) == 4

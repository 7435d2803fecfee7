"""A frame of the cell seen from another one."""

from __future__ import annotations

import math

import pytest

from engine.errors import SkillFailed
from engine.messages import FramePoses, Pose
from engine.teaching.frames import relative_pose

HALF = math.sqrt(0.5)
POSES = FramePoses(
    time_s=0.0,
    names=("table", "part"),
    xyz=((1.0, 2.0, 0.5), (1.0, 3.0, 0.7)),
    # The table is turned by a right angle about z, the part not at all.
    xyzw=((0.0, 0.0, HALF, HALF), (0.0, 0.0, 0.0, 1.0)),
)


def test_a_frame_is_seen_from_another_one() -> None:
    seen = relative_pose(POSES, "part", "table")
    assert seen.frame == "table"
    assert seen.xyz == pytest.approx((1.0, 0.0, 0.2))
    assert seen.xyzw == pytest.approx((0.0, 0.0, -HALF, HALF))


def test_a_frame_is_seen_from_the_world_as_it_was_given() -> None:
    assert relative_pose(POSES, "part", "world") == Pose(xyz=(1.0, 3.0, 0.7))


def test_the_world_is_seen_from_a_frame() -> None:
    seen = relative_pose(POSES, "world", "table")
    assert seen.xyz == pytest.approx((-2.0, 1.0, -0.5))


def test_a_frame_that_is_not_there_is_named() -> None:
    with pytest.raises(SkillFailed, match="there is no frame tabel"):
        relative_pose(POSES, "part", "tabel")

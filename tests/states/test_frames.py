"""Poses in frames: composing, undoing and turning agree with one another and with rotation matrices."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import Cause, StateError
from engine.messages import FramePoses, PartPoses, Pose, Quaternion, Vector3
from engine.messages.pose_algebra import (
    angle_between_rad,
    compose_poses,
    invert_pose,
    offset_along,
    rotate_vector,
    translate_pose,
)
from states.frames import frame_in_world, part_in_world
from tests.states.fake_context import FakeContext

METRES = st.floats(-2.0, 2.0)
POINTS = st.tuples(METRES, METRES, METRES)
NUMBERS = st.floats(-1.0, 1.0)
QUARTER = math.sqrt(0.5)


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    raw = draw(st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS).filter(lambda q: math.hypot(*q) > 0.1))
    x, y, z, w = (value / math.hypot(*raw) for value in raw)
    return Pose(xyz=draw(POINTS), xyzw=(x, y, z, w))


def matrix(xyzw: Quaternion, vector: Vector3) -> list[float]:
    """Turn a vector by the rotation matrix of a quaternion, as textbooks write it."""
    x, y, z, w = xyzw
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    return [sum(a * b for a, b in zip(row, vector, strict=True)) for row in rows]


@given(poses(), POINTS)
def test_a_vector_is_turned_as_by_the_matrix(pose: Pose, vector: Vector3) -> None:
    assert rotate_vector(pose.xyzw, vector) == pytest.approx(matrix(pose.xyzw, vector), abs=1e-9)


@given(poses(), poses(), POINTS)
def test_a_point_in_a_composed_frame_is_the_point_through_both(outer: Pose, inner: Pose, point: Vector3) -> None:
    at_point = Pose(xyz=point)
    both = compose_poses(outer, compose_poses(inner, at_point))
    assert compose_poses(compose_poses(outer, inner), at_point).xyz == pytest.approx(both.xyz, abs=1e-9)


@given(poses())
def test_a_pose_and_its_inverse_undo_one_another(pose: Pose) -> None:
    for nothing in (compose_poses(pose, invert_pose(pose)), compose_poses(invert_pose(pose), pose)):
        assert nothing.xyz == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
        assert angle_between_rad(nothing.xyzw, (0.0, 0.0, 0.0, 1.0)) == pytest.approx(0.0, abs=1e-4)


def test_a_quarter_turn_is_measured_whichever_sign_the_quaternion_has() -> None:
    quarter = (0.0, 0.0, QUARTER, QUARTER)
    assert angle_between_rad(quarter, (0.0, 0.0, 0.0, 1.0)) == pytest.approx(math.pi / 2)
    assert angle_between_rad(quarter, (0.0, 0.0, 0.0, -1.0)) == pytest.approx(math.pi / 2)


def test_a_way_in_a_direction_has_its_length() -> None:
    assert offset_along((0.0, 3.0, 4.0), 0.5) == pytest.approx((0.0, 0.3, 0.4))
    assert translate_pose(Pose(xyz=(1.0, 1.0, 1.0), frame="tray"), (0.0, 0.5, 0.0)) == Pose(
        xyz=(1.0, 1.5, 1.0), frame="tray"
    )


async def test_parts_and_frames_are_where_the_cell_shows_them() -> None:
    place = Pose(xyz=(0.1, 0.2, 0.3), xyzw=(0.0, 0.0, QUARTER, QUARTER))
    ctx = FakeContext(
        topics={
            "cell/parts": PartPoses(time_s=0.0, poses={"plate": place}),
            "cell/frames": FramePoses(time_s=0.0, names=("tray",), xyz=(place.xyz,), xyzw=(place.xyzw,)),
        }
    )
    assert await part_in_world(ctx, "plate") == place
    assert await frame_in_world(ctx, "tray") == place
    assert await frame_in_world(ctx, "world") == Pose(xyz=(0.0, 0.0, 0.0))
    assert await part_in_world(ctx, "plat") == Cause(
        message="no such part is in the cell; did you mean plate?", where="cell/parts"
    )
    with pytest.raises(StateError, match=r"the cell shows no frame tra \(did you mean tray\?\)"):
        await frame_in_world(ctx, "tra")

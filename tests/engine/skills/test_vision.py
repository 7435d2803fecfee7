"""Detections: the corners of oriented boxes, boxes in other frames, and choosing among what was found."""

from __future__ import annotations

import math

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose, rotate_vector
from engine.skills.vision import Detection, Detections

METRES = st.floats(-2.0, 2.0)
EDGES = st.floats(0.001, 1.0)
NUMBERS = st.floats(-1.0, 1.0)
LABELS = st.sampled_from(("front", "back", "battery"))


@st.composite
def poses(draw: st.DrawFn, frame: str = "world") -> Pose:
    raw = draw(st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS).filter(lambda q: math.hypot(*q) > 0.1))
    x, y, z, w = (value / math.hypot(*raw) for value in raw)
    return Pose(xyz=draw(st.tuples(METRES, METRES, METRES)), xyzw=(x, y, z, w), frame=frame)


@st.composite
def detections(draw: st.DrawFn, frame: str = "world") -> Detection:
    return Detection(
        label=draw(LABELS),
        score=draw(st.floats(0.0, 1.0)),
        pose=draw(poses(frame)),
        size_m=draw(st.tuples(EDGES, EDGES, EDGES)),
    )


def camera_message(*found: Detection, frame_pose: Pose) -> Detections:
    """Return a message of a camera."""
    return Detections(
        camera="top", frame="corner", time_s=1.5, detections=found, image_px=(640, 480), frame_pose=frame_pose
    )


@given(each=detections())
def test_the_eight_corners_are_half_an_edge_away_along_each_axis_of_the_box(each: Detection) -> None:
    assert len(set(each.vertices_m)) == 8
    back = invert_pose(each.pose)
    for corner in each.vertices_m:
        own = compose_poses(back, Pose(xyz=corner)).xyz
        assert [abs(value) for value in own] == pytest.approx([edge / 2 for edge in each.size_m], abs=1e-9)
    middle = [sum(axis) / 8 for axis in zip(*each.vertices_m, strict=True)]
    assert middle == pytest.approx(each.pose.xyz, abs=1e-9)


@given(each=detections())
def test_corners_are_in_order_x_slowest_and_z_fastest(each: Detection) -> None:
    first, *_ = each.vertices_m
    for corner, axis in ((4, (1.0, 0.0, 0.0)), (2, (0.0, 1.0, 0.0)), (1, (0.0, 0.0, 1.0))):
        edge = each.size_m[axis.index(1.0)]
        along = rotate_vector(each.pose.xyzw, axis)
        expected = [a + edge * b for a, b in zip(first, along, strict=True)]
        assert each.vertices_m[corner] == pytest.approx(expected, abs=1e-9)


@given(each=detections("corner"), frame=poses())
def test_a_box_in_a_frame_is_where_that_frame_puts_it_in_the_world(each: Detection, frame: Pose) -> None:
    world = camera_message(each, frame_pose=frame).in_world(each)
    assert world.frame == "world"
    assert compose_poses(invert_pose(frame), world).xyz == pytest.approx(each.pose.xyz, abs=1e-9)


@given(found=st.lists(detections(), max_size=6), label=LABELS, least=st.floats(0.0, 1.0))
def test_choosing_keeps_labels_and_scores_that_fit_in_their_order(
    found: list[Detection], label: str, least: float
) -> None:
    message = camera_message(*found, frame_pose=Pose(xyz=(0.0, 0.0, 0.0)))
    kept = message.only(labels=(label,), minimal_score=least).detections
    assert list(kept) == [each for each in found if each.label == label and each.score >= least]
    assert message.only() == message


@given(found=st.lists(detections("corner"), max_size=4), frame=poses())
def test_what_is_written_is_read_again(found: list[Detection], frame: Pose) -> None:
    message = camera_message(*found, frame_pose=frame)
    assert msgspec.json.decode(msgspec.json.encode(message), type=Detections) == message
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(message), type=Detections) == message


@pytest.mark.parametrize(
    "wrong", [b'"score": 1.1', b'"score": -0.1', b'"size_m": [0.1, 0, 0.1]', b'"label": ""', b'"colour": 1']
)
def test_what_is_no_detection_is_refused(wrong: bytes) -> None:
    good = b'{"label": "a", "score": 1, "pose": {"xyz": [0, 0, 0]}, "size_m": [1, 1, 1], %s}' % wrong
    with pytest.raises(msgspec.ValidationError):
        msgspec.json.decode(good, type=Detection)

"""What a camera finds becomes userdata, and what it does not find an outcome that says why."""

from __future__ import annotations

import math
from typing import cast

import pytest

from engine.errors import Cause, NoSuchSkill, SkillFailed
from engine.messages import Pose
from engine.skills.vision import Detection, Detections, DetectObjects
from engine.state import Outcome
from states.vision.detect import Detect
from tests.states.fake_context import FakeContext

ADDRESS = "top/detect_objects"
HALF = math.sqrt(0.5)


def cup(score: float, x: float = 0.0) -> Detection:
    """Return a cup in the frame of the table."""
    return Detection(label="cup", score=score, pose=Pose(xyz=(x, 0.0, 0.0), frame="table"), size_m=(0.1, 0.1, 0.1))


def camera(*found: Detection) -> FakeContext:
    """Return a context in which the camera finds this; the table stands turned at 1 m, 2 m."""
    table = Pose(xyz=(1.0, 2.0, 0.0), xyzw=(0.0, 0.0, HALF, HALF))
    answer = Detections(
        camera="top", frame="table", time_s=1.0, detections=found, image_px=(640, 480), frame_pose=table
    )
    return FakeContext({ADDRESS: answer})


async def test_what_is_found_is_written_the_best_first_where_it_is_in_the_world() -> None:
    context = camera(cup(0.6), cup(0.9, 0.5))
    outcome = await Detect(camera="top", label="cup", minimal_score=0.4).run(context)
    assert outcome.name == "found"
    assert outcome.outputs["label"] == "cup"
    pose, detections = outcome.outputs["pose"], cast("list[Detection]", outcome.outputs["detections"])
    assert isinstance(pose, Pose)
    assert pose.xyz == pytest.approx((1.0, 2.5, 0.0))
    assert pose.frame == "world"
    assert [each.score for each in detections] == [0.9, 0.6]
    assert detections[1].pose.xyz == pytest.approx((1.0, 2.0, 0.0))
    assert context.sent == [(ADDRESS, DetectObjects(labels=("cup",), minimal_score=0.4))]


async def test_without_a_label_anything_will_do() -> None:
    context = camera(cup(0.7))
    assert (await Detect(camera="top").run(context)).name == "found"
    assert context.sent == [(ADDRESS, DetectObjects(minimal_score=0.5))]


async def test_what_is_not_there_is_not_found_and_the_cause_says_so() -> None:
    because = Cause(message="no detection has a score of 0.50 or more", where=ADDRESS)
    assert await Detect(camera="top", label="cup").run(camera()) == Outcome(
        "not_found",
        {"detections": []},
        Cause(message="top did not detect cup", where="root/step", kind="vision.Detect", because=because),
    )


async def test_a_camera_without_images_fails_with_its_reason() -> None:
    context = FakeContext({ADDRESS: SkillFailed("nothing can be detected: its lens is covered", where="top")})
    outcome = await Detect(camera="top", label="cup").run(context)
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert outcome.cause.message == "top could not detect cup"
    assert outcome.cause.because is not None
    assert "its lens is covered" in outcome.cause.because.message


async def test_a_camera_that_detects_nothing_at_all_is_a_mistake() -> None:
    with pytest.raises(NoSuchSkill):
        await Detect(camera="top").run(FakeContext())

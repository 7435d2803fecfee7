"""What has moved enough to be another scene."""

from __future__ import annotations

from collections.abc import Mapping

from robots.model.transform import RigidTransform
from robots.workspace.measured_poses import MeasuredArm, MeasuredPoses
from robots.workspace.tracked_objects import TrackedObjects

UPRIGHT = (0.0, 0.0, 0.0, 1.0)


def seen(
    x_m: float = 0.0, *, turn: float = 0.0, joint_rad: float = 0.0, finger_m: float = 0.04, parts: bool = True
) -> MeasuredPoses:
    """Return a look at one part and one arm."""
    place = RigidTransform.of((x_m, 0.0, 0.0), (0.0, 0.0, turn / 2.0, 1.0))
    arms: Mapping[str, MeasuredArm] = {
        "left": MeasuredArm(joints_rad=(joint_rad, 0.0), tool_joints=(("finger", finger_m),))
    }
    return MeasuredPoses(
        arms=arms, parts={"part": place} if parts else {}, link=lambda arm, link: RigidTransform.of((0, 0, 0), UPRIGHT)
    )


def moved(things: TrackedObjects, look: MeasuredPoses) -> set[str]:
    """Return what has moved."""
    parts, arms = things.take(look)
    return {*parts, *arms}


def test_everything_is_new_at_first_and_then_only_what_moves_enough() -> None:
    things = TrackedObjects()
    assert moved(things, seen()) == {"part", "left"}
    assert moved(things, seen()) == set()
    assert moved(things, seen(0.0009, turn=0.008, joint_rad=0.0019)) == set()
    assert moved(things, seen(0.0011)) == {"part"}
    assert moved(things, seen(0.0011, turn=0.01)) == {"part"}
    assert moved(things, seen(0.0011, turn=0.01, joint_rad=0.0021)) == {"left"}
    assert things.arms["left"].joints_rad == (0.0021, 0.0)


def test_what_creeps_is_noticed_once_it_is_far_enough_from_where_it_was_noticed_last() -> None:
    things = TrackedObjects()
    things.take(seen())
    noticed = [step for step in range(1, 41) if moved(things, seen(0.0002 * step))]
    assert 5 <= len(noticed) <= 8


def test_fingers_that_move_are_noticed_in_steps_and_exactly_when_they_rest() -> None:
    things = TrackedObjects()
    things.take(seen(finger_m=0.04))
    assert moved(things, seen(finger_m=0.038)) == set()
    assert moved(things, seen(finger_m=0.035)) == {"left"}
    assert moved(things, seen(finger_m=0.0335)) == set()
    assert moved(things, seen(finger_m=0.0335)) == {"left"}
    assert things.arms["left"].tool_joints == (("finger", 0.0335),)
    assert moved(things, seen(finger_m=0.0335)) == set()

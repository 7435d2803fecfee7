"""The finger servo on a mass and a wall of our own: width, force, stall, patience."""

from __future__ import annotations

import pytest

from robots.control.motion_event import AnyMotionEvent, MotionFinished
from robots.control.tool_drives.finger_servo import FingerServo
from robots.model.registry import model_by_name
from robots.port import MotionEnd

GRIPPER = model_by_name("panda").gripper
assert GRIPPER is not None
STEP_S = 0.001
FINGER_KG = 0.2


class Fingers:
    """Two fingers alike, stopped by an object `wall_m` wide."""

    def __init__(self, *, wall_m: float) -> None:
        assert GRIPPER is not None
        self.servo = FingerServo(GRIPPER)
        self.wall_m = wall_m
        self.width_m = GRIPPER.max_width_m
        self.velocity_m_s = 0.0
        self.servo.initialize(self.width_m)

    def step(self) -> tuple[AnyMotionEvent, ...]:
        events = self.servo.step(STEP_S, width_m=self.width_m, velocity_m_s=self.velocity_m_s)
        self.velocity_m_s += 2.0 * self.servo.force_n / FINGER_KG * STEP_S
        self.width_m += self.velocity_m_s * STEP_S
        if self.width_m <= self.wall_m:
            self.width_m, self.velocity_m_s = self.wall_m, max(self.velocity_m_s, 0.0)
        return events

    def until_event(self, limit: int = 6000) -> tuple[AnyMotionEvent, int]:
        for step in range(limit):
            for event in self.step():
                return event, step
        raise AssertionError("nothing was told")


def test_without_an_object_the_fingers_reach_the_width_at_the_speed() -> None:
    fingers = Fingers(wall_m=0.0)
    fingers.servo.close_to(1, width_m=0.03, speed_m_s=0.1, force_n=40.0, now_m=fingers.width_m)
    event, steps = fingers.until_event()
    assert isinstance(event, MotionFinished)
    assert (event.report.end, event.progress) == (MotionEnd.REACHED, pytest.approx(1.0, abs=0.02))
    assert fingers.width_m == pytest.approx(0.03, abs=0.001)
    assert 500 <= steps < 700


def test_against_an_object_the_force_builds_up_is_never_exceeded_and_stays() -> None:
    fingers = Fingers(wall_m=0.03)
    fingers.servo.close_to(1, width_m=0.0, speed_m_s=0.05, force_n=25.0, now_m=fingers.width_m)
    event, _ = fingers.until_event()
    assert isinstance(event, MotionFinished)
    assert event.report.end == MotionEnd.REACHED
    for _ in range(500):
        fingers.step()
        assert fingers.servo.force_n == pytest.approx(-25.0)


def test_the_force_follows_an_object_that_gives() -> None:
    fingers = Fingers(wall_m=0.03)
    fingers.servo.close_to(1, width_m=0.0, speed_m_s=0.05, force_n=25.0, now_m=fingers.width_m)
    fingers.until_event()
    fingers.wall_m = 0.028
    for _ in range(300):
        fingers.step()
    assert (fingers.width_m, fingers.servo.force_n) == (0.028, pytest.approx(-25.0))


def test_a_stronger_grip_takes_over_without_letting_go() -> None:
    fingers = Fingers(wall_m=0.03)
    fingers.servo.close_to(1, width_m=0.0, speed_m_s=0.05, force_n=20.0, now_m=fingers.width_m)
    fingers.until_event()
    fingers.servo.close_to(2, width_m=0.0, speed_m_s=0.05, force_n=50.0, now_m=fingers.width_m)
    weakest = 50.0
    for _ in range(400):
        fingers.step()
        weakest = min(weakest, -fingers.servo.force_n)
    assert weakest >= 19.0
    assert fingers.servo.force_n == pytest.approx(-50.0)


def test_a_servo_that_takes_over_from_another_presses_on_with_the_same_force() -> None:
    before, after = Fingers(wall_m=0.03), Fingers(wall_m=0.03)
    before.servo.close_to(1, width_m=0.0, speed_m_s=0.05, force_n=25.0, now_m=before.width_m)
    before.until_event()
    after.width_m = before.width_m
    after.servo.take_over(before.servo.command)
    for _ in range(500):
        after.step()
        assert after.servo.force_n == pytest.approx(-25.0)
    assert after.servo.command == before.servo.command


def test_a_servo_that_takes_over_in_mid_way_stops_there_and_tells_nothing() -> None:
    before, after = Fingers(wall_m=0.0), Fingers(wall_m=0.0)
    before.servo.close_to(1, width_m=0.0, speed_m_s=0.05, force_n=25.0, now_m=before.width_m)
    for _ in range(600):
        before.step()
    after.width_m = before.width_m
    after.servo.close_to(2, width_m=0.08, speed_m_s=0.05, force_n=25.0, now_m=after.width_m)
    after.servo.take_over(before.servo.command)
    assert [after.step() for _ in range(500)] == [()] * 500
    assert (after.servo.number, after.width_m) == (0, pytest.approx(before.width_m, abs=0.0005))


def test_fingers_that_never_rest_fail_in_words() -> None:
    fingers = Fingers(wall_m=0.0)
    fingers.servo.close_to(1, width_m=0.0, speed_m_s=0.1, force_n=20.0, now_m=fingers.width_m)
    for step in range(4000):
        told = fingers.servo.step(STEP_S, width_m=0.05, velocity_m_s=0.5 if step % 2 else -0.5)
        if told:
            (end,) = told
            assert isinstance(end, MotionFinished)
            assert end.report.end == MotionEnd.FAILED
            assert "neither reached 0.0 mm nor stopped against an object" in end.report.reason
            return
    raise AssertionError("it waited for ever")


def test_fingers_that_are_stopped_for_a_cause_fail_with_it_and_stay_where_they_are() -> None:
    fingers = Fingers(wall_m=0.0)
    fingers.servo.close_to(1, width_m=0.0, speed_m_s=0.05, force_n=40.0, now_m=fingers.width_m)
    for _ in range(200):
        assert fingers.step() == ()
    fingers.servo.stop("the engine was silent")
    event, _ = fingers.until_event()
    assert isinstance(event, MotionFinished)
    assert (event.report.end, event.report.reason) == (MotionEnd.FAILED, "the engine was silent")
    left_at_m = fingers.width_m
    for _ in range(1000):
        fingers.step()
    assert left_at_m > 0.05
    assert fingers.width_m == pytest.approx(left_at_m, abs=1e-4)

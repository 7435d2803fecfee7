"""The motor of a soft hand on a tendon of our own: share and time, stall, hold, cancel, another life."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.control.tool_drives.tendon_servo import TendonServo
from robots.port import MotionEnd

STEP_S = 0.001
TRAVEL_M, FORCE_N = 0.17, 150.0
SPRING_N_M, DAMPER_NS_M, FINGERS_KG = 40.0, 20.0, 0.5


class Tendon:
    """Fingers on springs, stopped by what they hold once `blocked_m` of tendon is pulled."""

    def __init__(self, *, blocked_m: float = 1.0) -> None:
        self.servo = TendonServo(travel_m=TRAVEL_M, max_speed_m_s=0.15, max_force_n=FORCE_N)
        self.blocked_m = blocked_m
        self.pulled_m = 0.0
        self.velocity_m_s = 0.0
        self.passed_s = 0.0

    def step(self) -> tuple[AnyMotionEvent, ...]:
        pull_n = self.servo.force_n - SPRING_N_M * self.pulled_m - DAMPER_NS_M * self.velocity_m_s
        self.velocity_m_s += pull_n / FINGERS_KG * STEP_S
        self.pulled_m += self.velocity_m_s * STEP_S
        if self.pulled_m >= self.blocked_m:
            self.pulled_m, self.velocity_m_s = self.blocked_m, min(self.velocity_m_s, 0.0)
        self.passed_s += STEP_S
        return self.servo.step(STEP_S, pulled_m=self.pulled_m, velocity_m_s=self.velocity_m_s)

    def until_event(self, limit: int = 20_000) -> AnyMotionEvent:
        for _ in range(limit):
            for event in self.step():
                return event
        raise AssertionError("nothing was told")


def finished(event: AnyMotionEvent) -> tuple[MotionEnd, str]:
    assert isinstance(event, MotionFinished)
    return event.report.end, event.report.reason


@settings(max_examples=10, deadline=None)
@given(share=st.floats(0.05, 1.0), time_s=st.floats(1.5, 4.0))
def test_a_free_hand_closes_by_the_share_in_the_time(share: float, time_s: float) -> None:
    tendon = Tendon()
    tendon.servo.close_to(1, share=share, time_s=time_s)
    assert finished(tendon.until_event()) == (MotionEnd.REACHED, "")
    assert tendon.servo.closed_share == pytest.approx(share)
    # Its seconds are a sum of steps.
    assert time_s - 1e-9 < tendon.passed_s < time_s + 0.5


def test_a_time_too_short_is_as_fast_as_the_motor_can() -> None:
    tendon = Tendon()
    tendon.servo.close_to(1, share=1.0, time_s=0.01)
    tendon.until_event()
    assert tendon.passed_s > TRAVEL_M / 0.15


def test_a_blocked_hand_stalls_at_its_whole_force_and_keeps_it() -> None:
    tendon = Tendon(blocked_m=0.08)
    tendon.servo.close_to(1, share=1.0, time_s=1.0)
    assert finished(tendon.until_event()) == (MotionEnd.REACHED, "")
    for _ in range(500):
        tendon.step()
        assert tendon.servo.force_n == pytest.approx(FORCE_N, rel=0.05)


@settings(max_examples=15, deadline=None)
@given(share=st.floats(0.0, 1.0), blocked_m=st.floats(0.01, 0.2))
def test_the_motor_never_pushes_and_never_pulls_harder_than_it_can(share: float, blocked_m: float) -> None:
    tendon = Tendon(blocked_m=blocked_m)
    tendon.servo.close_to(1, share=share, time_s=0.5)
    for _ in range(800):
        tendon.step()
        assert 0.0 <= tendon.servo.force_n <= FORCE_N


def test_a_held_hand_stands_still_and_goes_on_when_resumed() -> None:
    tendon = Tendon()
    tendon.servo.close_to(1, share=0.8, time_s=1.0)
    for _ in range(400):
        assert tendon.step() == ()
    tendon.servo.hold(1, request=1)
    assert tendon.until_event() == MotionHeld(motion=1, request=1)
    share = tendon.servo.closed_share
    for _ in range(300):
        assert tendon.step() == ()
    assert tendon.servo.closed_share == share < 0.5
    tendon.servo.resume(1, request=2)
    assert tendon.until_event() == MotionResumed(motion=1, request=2)
    assert finished(tendon.until_event()) == (MotionEnd.REACHED, "")


def test_a_cancelled_hand_stays_where_it_is() -> None:
    tendon = Tendon()
    tendon.servo.close_to(1, share=1.0, time_s=2.0)
    for _ in range(1000):
        tendon.step()
    tendon.servo.cancel(1)
    assert finished(tendon.until_event()) == (MotionEnd.CANCELED, "")
    share = tendon.servo.closed_share
    for _ in range(500):
        tendon.step()
    assert tendon.servo.closed_share == share == pytest.approx(0.5, abs=0.05)


def test_a_motor_that_takes_over_from_another_pulls_on() -> None:
    before, after = Tendon(blocked_m=0.08), Tendon(blocked_m=0.08)
    before.servo.close_to(1, share=0.6, time_s=1.0)
    before.until_event()
    after.pulled_m = before.pulled_m
    after.servo.take_over(before.servo.command)
    for _ in range(300):
        after.step()
    assert after.servo.force_n == pytest.approx(before.servo.force_n, rel=0.02)
    assert after.servo.command == before.servo.command


def test_fingers_that_never_rest_fail_in_words() -> None:
    servo = TendonServo(travel_m=TRAVEL_M, max_speed_m_s=0.15, max_force_n=FORCE_N)
    servo.close_to(1, share=0.7, time_s=1.0)
    for step in range(5000):
        for event in servo.step(STEP_S, pulled_m=0.05, velocity_m_s=0.5 if step % 2 else -0.5):
            assert finished(event)[0] == MotionEnd.FAILED
            assert "while closing to 70 %" in finished(event)[1]
            return
    raise AssertionError("it waited for ever")

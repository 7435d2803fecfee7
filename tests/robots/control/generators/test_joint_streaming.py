"""Direct joint control: values at any rate, silence, holds, limits."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.generators.joint_streaming import JointStreamGenerator
from robots.control.generators.motion_generator import StreamGenerator
from tests.robots.control.limit_watch import STEP_S, LimitWatch, limits
from tests.robots.control.plane_arm import plane_state

STATE = plane_state()


def new_streaming(*, watchdog_s: float = 0.1, jerk_rad_s3: float = 2000.0) -> JointStreamGenerator:
    return JointStreamGenerator(
        limits=limits(jerk_rad_s3=jerk_rad_s3), joints=("shoulder", "elbow"), start=np.zeros(2), watchdog_s=watchdog_s
    )


def swing(time_s: float) -> np.ndarray:
    """Return a smooth way of 0.8 rad to and fro in 2.5 s that begins at zero and at rest."""
    return np.array([0.4, -0.2]) * (1.0 - np.cos(2.0 * np.pi * 0.4 * time_s))


def test_it_is_a_stream_generator() -> None:
    assert isinstance(new_streaming(), StreamGenerator)


@pytest.mark.parametrize(("period", "lag_s"), [(1, 0.004), (2, 0.006), (8, 0.022), (20, 0.055), (33, 0.09)])
def test_the_set_point_follows_a_smooth_stream_of_any_rate_less_than_three_periods_late(
    period: int, lag_s: float
) -> None:
    streaming = new_streaming()
    watch = LimitWatch(limits(), streaming)
    for step in range(2500):
        if step % period == 0:
            streaming.receive(swing(step * STEP_S))
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    times = np.arange(500, 2500) * STEP_S
    wanted = np.array([swing(t - lag_s) for t in times])
    error = np.abs(np.array(watch.positions[501:]) - wanted).max()
    assert error < 0.4 * 2.0 * np.pi * 0.4 * 0.004 + 0.02 * lag_s / 0.02
    # Smooth: it needs hardly more acceleration than the stream itself.
    assert np.abs(np.array(watch.accelerations[500:])).max() < 1.6 * 0.4 * (2.0 * np.pi * 0.4) ** 2


def test_values_that_arrive_irregularly_are_followed_without_a_stop() -> None:
    random = np.random.default_rng(1)
    streaming = new_streaming()
    watch = LimitWatch(limits(), streaming)
    due_s = 0.0
    for step in range(2500):
        now_s = step * STEP_S
        if now_s >= due_s:
            streaming.receive(swing(now_s))
            due_s = now_s + 0.008 * random.uniform(0.6, 1.4)
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    wanted = np.array([swing(t - 0.02) for t in np.arange(500, 2500) * STEP_S])
    assert np.abs(np.array(watch.positions[501:]) - wanted).max() < 0.01


def test_silence_longer_than_the_watchdog_brings_it_to_rest_and_the_next_value_sets_it_going_again() -> None:
    streaming = new_streaming(watchdog_s=0.05)
    watch = LimitWatch(limits(), streaming)
    for step in range(600):
        if step % 8 == 0:
            streaming.receive(swing(step * STEP_S))
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    moving = streaming.velocity[0]
    for _ in range(400):
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    assert moving > 0.5
    assert streaming.stopped
    assert not streaming.complete
    rested = streaming.position[0]
    assert rested < swing(0.6)[0] + 0.06
    streaming.receive(np.array([rested + 0.1, 0.0]))
    for _ in range(40):
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    assert streaming.position[0] > rested


def test_before_the_first_value_it_stands_still() -> None:
    streaming = new_streaming()
    for _ in range(200):
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
    assert streaming.position.tolist() == [0.0, 0.0]
    assert streaming.stopped


def test_held_it_rests_and_on_resuming_it_catches_up_with_the_stream() -> None:
    streaming = new_streaming()
    watch = LimitWatch(limits(), streaming)
    for step in range(2500):
        if step % 4 == 0:
            streaming.receive(swing(step * STEP_S))
        held = 500 <= step < 1000
        streaming.step(STEP_S, target_pace=0.0 if held else 1.0, state=STATE)
        watch.look()
        if step == 999:
            assert streaming.stopped
            assert not streaming.moving
    assert np.abs(streaming.position - swing(2.5 - 0.01)).max() < 0.01


def test_finishing_comes_to_rest_and_is_complete_then_only() -> None:
    streaming = new_streaming(watchdog_s=10.0)
    watch = LimitWatch(limits(), streaming)
    streaming.receive(np.array([1.5, 1.0]))
    for _ in range(300):
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    streaming.finish()
    assert not streaming.complete
    steps = 0
    while not streaming.complete:
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
        steps += 1
    assert 100 < steps < 200
    assert (streaming.progress, streaming.goal, streaming.contact, streaming.leads) == (1.0, None, False, True)


def test_an_angle_beyond_a_limit_is_taken_as_the_limit_and_remembered() -> None:
    streaming = new_streaming(watchdog_s=10.0)
    watch = LimitWatch(limits(), streaming)
    for _ in range(2000):
        streaming.receive(np.array([0.1, -2.5]))
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
    assert np.allclose(streaming.position, [0.1, -2.0], atol=1e-6)
    assert streaming.warning == "set point of elbow beyond its limit: -2.500 rad, clipped to -2.000 rad"
    assert streaming.data() == streaming.warning.encode()


def test_a_speed_override_slows_a_single_target_down() -> None:
    streaming = new_streaming(watchdog_s=10.0)
    streaming.receive(np.array([1.0, 0.0]))
    fastest = 0.0
    for _ in range(1000):
        streaming.step(STEP_S, target_pace=0.25, state=STATE)
        fastest = max(fastest, float(streaming.velocity[0]))
    assert 0.49 < fastest <= 0.5


@settings(deadline=None, max_examples=40)
@given(
    st.lists(
        st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.integers(0, 150), st.sampled_from([0.0, 0.3, 1.0])),
        min_size=1,
        max_size=25,
    ),
    st.sampled_from([150.0, 2000.0, 7500.0]),
)
def test_whatever_comes_whenever_the_limits_hold_and_it_can_be_cancelled(
    told: list[tuple[float, float, int, float]], jerk: float
) -> None:
    streaming = new_streaming(jerk_rad_s3=jerk)
    watch = LimitWatch(limits(jerk_rad_s3=jerk), streaming)
    for shoulder, elbow, periods, pace in told:
        streaming.receive(np.array([shoulder, elbow]))
        for _ in range(periods):
            streaming.step(STEP_S, target_pace=pace, state=STATE)
            watch.look()
    for _ in range(600):
        streaming.step(STEP_S, target_pace=0.0, state=STATE)
        watch.look()
    assert streaming.stopped


def test_seven_joints_take_less_than_a_tenth_of_a_millisecond_a_period() -> None:
    seven = JointStreamGenerator(limits=limits(7), joints=("j",) * 7, start=np.zeros(7), watchdog_s=0.1)
    start = time.thread_time()
    for step in range(1000):
        seven.receive(np.full(7, float(swing(step * STEP_S)[0])))
        seven.step(STEP_S, target_pace=1.0, state=STATE)
    assert time.thread_time() - start < 0.1 * 3


def test_a_stream_has_no_progress_until_it_has_finished() -> None:
    streaming = new_streaming()
    streaming.receive(swing(0.3))
    streaming.step(STEP_S, target_pace=1.0, state=STATE)
    before = streaming.progress
    streaming.finish()
    while not streaming.complete:
        streaming.step(STEP_S, target_pace=1.0, state=STATE)
    assert (before, streaming.progress) == (0.0, 1.0)

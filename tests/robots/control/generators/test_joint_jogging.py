"""Joints jogged by velocities: limits, watchdog, reversal."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.generators.joint_jogging import JointJogGenerator
from tests.robots.control.limit_watch import STEP_S, LimitWatch, limits
from tests.robots.control.plane_arm import plane_state

STATE = plane_state()


def run(
    jogging: JointJogGenerator, watch: LimitWatch, velocity: tuple[float, float], periods: int, *, pace: float = 1.0
) -> None:
    """Send the same velocities in every period."""
    for _ in range(periods):
        jogging.receive(np.array(velocity))
        jogging.step(STEP_S, target_pace=pace, state=STATE)
        watch.look()


def new_jogging(jerk_rad_s3: float = 2000.0) -> tuple[JointJogGenerator, LimitWatch]:
    own = limits(jerk_rad_s3=jerk_rad_s3)
    jogging = JointJogGenerator(limits=own, start=np.zeros(2), watchdog_s=0.1)
    return jogging, LimitWatch(own, jogging)


def test_each_joint_takes_on_its_velocity() -> None:
    jogging, watch = new_jogging()
    run(jogging, watch, (0.7, -0.004), 400)
    assert np.allclose(jogging.velocity, [0.7, -0.004], atol=1e-9)


def test_a_joint_comes_to_rest_at_its_limit_while_the_other_one_goes_on() -> None:
    jogging, watch = new_jogging()
    run(jogging, watch, (1.5, -0.3), 3000)
    assert abs(jogging.position[0] - 2.0) < 1e-6
    assert abs(jogging.velocity[1] + 0.3) < 1e-9
    run(jogging, watch, (-0.5, -0.3), 500)
    assert jogging.position[0] < 1.9


def test_it_reverses_within_its_acceleration() -> None:
    jogging, watch = new_jogging()
    run(jogging, watch, (1.5, 0.0), 500)
    run(jogging, watch, (-1.5, 0.0), 500)
    assert abs(jogging.velocity[0] + 1.5) < 1e-9


def test_it_stops_when_nothing_is_sent_and_when_it_is_held() -> None:
    for pace, periods in ((1.0, 500), (0.0, 300)):
        jogging, watch = new_jogging()
        run(jogging, watch, (1.0, 1.0), 300)
        for _ in range(periods):
            jogging.step(STEP_S, target_pace=pace, state=STATE)
            watch.look()
        assert jogging.stopped
        assert 0.2 < jogging.position[0] < 0.6


def test_a_speed_override_scales_what_is_sent() -> None:
    jogging, watch = new_jogging()
    run(jogging, watch, (1.0, -0.5), 400, pace=0.1)
    assert np.allclose(jogging.velocity, [0.1, -0.05], atol=1e-9)


@settings(deadline=None, max_examples=40)
@given(
    st.lists(st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0), st.integers(1, 300)), min_size=1, max_size=8),
    st.sampled_from([150.0, 2000.0, 7500.0]),
)
def test_whatever_is_sent_it_never_passes_a_limit(sent: list[tuple[float, float, int]], jerk: float) -> None:
    jogging, watch = new_jogging(jerk)
    for shoulder, elbow, periods in sent:
        run(jogging, watch, (shoulder, elbow), periods)


def test_what_is_passed_on_anew_is_no_sign_of_life() -> None:
    """Said once and passed on again and again: the joint brakes when the word itself is older than the watchdog."""
    jogging, watch = new_jogging()
    run(jogging, watch, (0.7, 0.0), 400)
    brakes_after_s = 0.0
    for k in range(1, 400):
        age_s = k * STEP_S
        if age_s < 0.095:
            jogging.receive(np.array([0.7, 0.0]), age_s=age_s)
        jogging.step(STEP_S, target_pace=1.0, state=STATE)
        watch.look()
        if jogging.velocity[0] < 0.69:
            brakes_after_s = age_s
            break
    assert 0.1 < brakes_after_s < 0.11

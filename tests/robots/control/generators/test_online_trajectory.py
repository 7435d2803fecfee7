"""Whatever joints are asked for, they keep their limits and can be brought to rest."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from tests.robots.control.limit_watch import STEP_S, LimitWatch, limits
from tests.robots.panda_arm import panda_model

numbers = st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
asks = st.tuples(st.sampled_from(["go", "track", "run", "together", "brake"]), numbers, st.integers(1, 150))


def ask(shaper: OnlineTrajectoryGenerator, what: str, values: tuple[float, float]) -> None:
    """Ask for one period of one of the five."""
    numbers_rad = np.array(values)
    inside = np.clip(numbers_rad + (shaper.lower_rad + shaper.upper_rad) / 2.0, shaper.lower_rad, shaper.upper_rad)
    match what:
        case "go":
            shaper.go_to(STEP_S, position=inside, pace=0.3 + abs(values[0]) / 5.0)
        case "track":
            shaper.track(STEP_S, position=inside, velocity=numbers_rad[::-1], acceleration=5.0 * numbers_rad, pace=1.0)
        case "run":
            shaper.run(STEP_S, velocity=numbers_rad)
        case "together":
            shaper.run_together(STEP_S, velocity=np.clip(numbers_rad, -2.0, 2.0), turning=10.0 * numbers_rad[::-1])
        case _:
            shaper.brake(STEP_S)


@settings(deadline=None, max_examples=30)
@given(
    st.lists(asks, min_size=1, max_size=6),
    st.sampled_from([0.5, 0.9]),
    st.sampled_from([150.0, 1000.0, 7500.0]),
    st.sampled_from([0.0, -3.0]),
    st.floats(-2.0, 2.0),
)
def test_whatever_is_asked_in_turn_no_limit_is_passed_and_it_stops(
    turns: list[tuple[str, tuple[float, float], int]], share: float, jerk: float, middle: float, start: float
) -> None:
    own = limits(jerk_rad_s3=jerk, middle_rad=middle)
    shaper = OnlineTrajectoryGenerator(limits=own, start=np.array([middle + start, middle]), share=share)
    watch = LimitWatch(own, shaper)
    for what, values, periods in turns:
        for _ in range(periods):
            ask(shaper, what, values)
            watch.look()
    for _ in range(600):
        shaper.brake(STEP_S)
        watch.look()
    assert shaper.at_rest
    assert shaper.velocity.tolist() == [0.0, 0.0]


def test_a_single_target_is_reached_as_soon_as_the_limits_allow() -> None:
    shaper = OnlineTrajectoryGenerator(limits=limits(jerk_rad_s3=7500.0), start=np.zeros(2))
    periods = 0
    while not np.allclose(shaper.position, [1.0, -0.2], atol=1e-9) or not shaper.at_rest:
        shaper.go_to(STEP_S, position=np.array([1.0, -0.2]), pace=1.0)
        periods += 1
        assert periods < 1000
    # 2 rad/s with 13.5 rad/s² takes 1 / 2 + 2 / 13.5 s, and 2 ms more for the jerk.
    assert 648 <= periods <= 653


def test_an_arm_that_stands_beyond_a_limit_may_stay_and_come_back_but_go_no_farther() -> None:
    shaper = OnlineTrajectoryGenerator(limits=limits(), start=np.array([2.1, 0.0]))
    for _ in range(500):
        shaper.run(STEP_S, velocity=np.array([1.0, 0.0]))
    assert shaper.position[0] == 2.1
    for _ in range(500):
        shaper.run(STEP_S, velocity=np.array([-1.0, 0.0]))
    assert shaper.position[0] < 1.7


def test_joints_that_run_together_keep_their_ratio_from_rest() -> None:
    shaper = OnlineTrajectoryGenerator(limits=limits(), start=np.zeros(2), share=0.5)
    wanted = np.array([1.0, -0.25])
    for _ in range(400):
        shaper.run_together(STEP_S, velocity=wanted, turning=np.zeros(2))
        assert abs(shaper.position[0] * wanted[1] - shaper.position[1] * wanted[0]) < 1e-12
    assert np.allclose(shaper.velocity, wanted, rtol=1e-3)


def test_a_set_point_that_takes_over_a_moving_arm_stops_from_its_velocity() -> None:
    shaper = OnlineTrajectoryGenerator(limits=limits(), start=np.zeros(2))
    shaper.place(np.array([0.3, 0.0]), np.array([0.8, 0.0]))
    shaper.brake(STEP_S)
    assert 0.7 < shaper.velocity[0] < 0.8
    for _ in range(200):
        shaper.brake(STEP_S)
    assert shaper.at_rest
    assert 0.3 < shaper.position[0] < 0.36


def test_a_joint_that_stops_at_its_limit_does_not_jerk_there() -> None:
    """What a stop goes beyond the limit is cut off at once, so it has to be very little."""
    arm = panda_model().limits
    lower_rad, jerk_rad_s3 = np.array(arm.lower_rad), np.array(arm.jerk_rad_s3)
    for seed in range(50, 60):
        shaper = OnlineTrajectoryGenerator(limits=arm, start=lower_rad + 0.05)
        velocity = -np.random.default_rng(seed).uniform(0.05, 0.6, len(lower_rad))
        target, sent = lower_rad + 0.05, [lower_rad + 0.05] * 3
        for _ in range(300):
            target = target + velocity * STEP_S
            shaper.track(STEP_S, position=target, velocity=velocity, acceleration=np.zeros_like(velocity), pace=1.0)
            sent.append(shaper.position.copy())
        assert (np.abs(np.diff(sent, 3, axis=0)) / STEP_S**3 < 1.01 * jerk_rad_s3).all(), seed

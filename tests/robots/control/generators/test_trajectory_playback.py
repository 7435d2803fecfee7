"""Passage along a trajectory: never off the path, never beyond the joints' acceleration, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from engine.errors import RobotError
from robots.control.generators.trajectory_playback import TrajectoryPlayback, validate_trajectory
from robots.port import Array, JointTrajectory

LIMIT = np.array([15.0, 7.5])
JERK = np.array([7500.0, 3750.0])
JOINTS = ("shoulder", "elbow")


def smooth(goal: Array, duration_s: float, *, dt_s: float = 0.002) -> JointTrajectory:
    """Return a minimum-jerk motion from zero."""
    u = np.linspace(0.0, 1.0, round(duration_s / dt_s) + 1)[:, None]
    return JointTrajectory(
        dt_s=dt_s,
        position_rad=goal * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=goal * (30 * u**2 - 60 * u**3 + 30 * u**4) / duration_s,
    )


@settings(deadline=None, max_examples=40)
@given(st.lists(st.integers(1, 300), min_size=1, max_size=6), st.floats(0.3, 1.0))
def test_however_it_is_held_and_resumed_it_stays_on_the_path_within_the_acceleration(
    switches: list[int], reach: float
) -> None:
    goal = np.array([1.0, -0.5]) * reach
    playback = TrajectoryPlayback(smooth(goal, 1.0), acceleration_rad_s2=LIMIT, jerk_rad_s3=JERK)
    velocities, pace = [playback.velocity.copy()], 1.0
    for steps in [*switches, 2000]:
        for _ in range(steps):
            playback.step(0.001, target_pace=pace)
            velocities.append(playback.velocity.copy())
            # On this straight path the joints' positions have a fixed ratio.
            assert abs(playback.position[0] * goal[1] - playback.position[1] * goal[0]) < 1e-12
        pace = 1.0 - pace
    assert (np.abs(np.diff(np.array(velocities), axis=0)) / 0.001 <= LIMIT * 1.02).all()


def winding(duration_s: float, *, dt_s: float = 0.005) -> JointTrajectory:
    """Return a curved motion from rest to rest on which both joints turn round, within the acceleration."""
    u = np.linspace(0.0, 1.0, round(duration_s / dt_s) + 1)
    share, rate = 10 * u**3 - 15 * u**4 + 6 * u**5, (30 * u**2 - 60 * u**3 + 30 * u**4) / duration_s
    turn = 2.0 * np.pi * share
    return JointTrajectory(
        dt_s=dt_s,
        position_rad=np.stack([0.2 * np.sin(turn), 0.1 * (np.cos(2.0 * turn) - 1.0)], axis=1),
        velocity_rad_s=np.stack([0.4 * np.pi * np.cos(turn) * rate, -0.4 * np.pi * np.sin(2.0 * turn) * rate], axis=1),
    )


@settings(deadline=None, max_examples=15)
@given(
    st.lists(st.tuples(st.floats(0.0, 1.0), st.integers(1, 200)), min_size=1, max_size=12), st.sampled_from([0.02, 0.1])
)
def test_at_any_sequence_of_paces_the_path_is_never_left_nor_the_acceleration_exceeded(
    paces: list[tuple[float, int]], shortest_stop_s: float
) -> None:
    trajectory = winding(3.0)
    playback = TrajectoryPlayback(
        trajectory, acceleration_rad_s2=LIMIT, jerk_rad_s3=JERK, shortest_stop_s=shortest_stop_s
    )
    positions, velocities, passed = [playback.position.copy()], [playback.velocity.copy()], [0.0]
    for pace, steps in [*paces, (1.0, 3200)]:
        for _ in range(steps):
            playback.step(0.001, target_pace=pace)
            positions.append(playback.position.copy())
            velocities.append(playback.velocity.copy())
            passed.append(playback.passed_s)
    assert playback.at_end
    knots = np.arange(len(trajectory.position_rad)) * trajectory.dt_s
    path = CubicHermiteSpline(knots, trajectory.position_rad, trajectory.velocity_rad_s)
    assert np.abs(np.array(positions) - path(np.array(passed))).max() < 1e-9
    steps_s = np.diff(np.array(passed))
    assert steps_s.min() >= 0.0
    assert steps_s.max() <= 0.001 + 1e-12
    middle = (np.array(velocities[1:]) + np.array(velocities[:-1])) / 2.0
    way = np.array(positions)
    assert np.abs((way[1:] - way[:-1]) / 0.001 - middle).max() < 5e-3
    assert (np.abs(np.diff(np.array(velocities), axis=0)) / 0.001 <= LIMIT * 1.02).all()


@settings(deadline=None, max_examples=12)
@given(st.floats(0.1, 1.0))
def test_a_speed_override_from_the_start_takes_its_share_of_the_speed_all_the_way(pace: float) -> None:
    playback = TrajectoryPlayback(smooth(np.array([1.0, -0.5]), 0.5), acceleration_rad_s2=LIMIT, jerk_rad_s3=JERK)
    steps, fastest = 0, 0.0
    while not playback.at_end:
        playback.step(0.001, target_pace=pace)
        fastest = max(fastest, float(playback.velocity[0]))
        steps += 1
    assert abs(steps - 500.0 / pace) <= 2.0
    assert fastest <= pace * 3.7501


def test_undisturbed_it_takes_its_own_time_and_ends_at_rest_at_the_goal() -> None:
    playback = TrajectoryPlayback(smooth(np.array([1.0, -0.5]), 0.5), acceleration_rad_s2=LIMIT, jerk_rad_s3=JERK)
    steps = 0
    while not playback.at_end:
        playback.step(0.001, target_pace=1.0)
        steps += 1
    assert steps in (500, 501)
    assert playback.position.tolist() == [1.0, -0.5]
    assert playback.velocity.tolist() == [0.0, 0.0]
    assert playback.progress == 1.0


def test_between_coarse_samples_the_set_point_follows_the_same_curve() -> None:
    coarse = TrajectoryPlayback(
        smooth(np.array([1.0, 0.0]), 1.0, dt_s=0.02), acceleration_rad_s2=LIMIT, jerk_rad_s3=JERK
    )
    fine = smooth(np.array([1.0, 0.0]), 1.0, dt_s=0.001)
    for index in range(1, 1000):
        coarse.step(0.001, target_pace=1.0)
        assert abs(coarse.position[0] - fine.position_rad[index, 0]) < 1e-5
        assert abs(coarse.velocity[0] - fine.velocity_rad_s[index, 0]) < 2e-3


def test_a_stop_takes_at_least_a_tenth_of_a_second_even_when_slow() -> None:
    playback = TrajectoryPlayback(smooth(np.array([0.01, 0.0]), 2.0), acceleration_rad_s2=LIMIT, jerk_rad_s3=JERK)
    for _ in range(1000):
        playback.step(0.001, target_pace=1.0)
    steps = 0
    while not playback.stopped:
        playback.step(0.001, target_pace=0.0)
        steps += 1
    assert 95 <= steps <= 105


@pytest.mark.parametrize(
    ("position", "velocity", "message"),
    [
        (np.zeros((5, 3)), np.zeros((5, 3)), "not a trajectory for 2 joints"),
        (np.zeros((1, 2)), np.zeros((1, 2)), "not a trajectory"),
        (np.full((5, 2), np.nan), np.zeros((5, 2)), "not finite"),
        (np.full((5, 2), 0.2), np.zeros((5, 2)), r"0\.2 rad from the set point of shoulder"),
        (np.full((5, 2), 1e-6), np.zeros((5, 2)), r"1e-06 rad from the set point of shoulder"),
        (np.zeros((5, 2)), np.ones((5, 2)), "at rest"),
    ],
)
def test_what_cannot_be_followed_is_refused_with_the_reason(position: Array, velocity: Array, message: str) -> None:
    trajectory = JointTrajectory(dt_s=0.001, position_rad=position, velocity_rad_s=velocity)
    with pytest.raises(RobotError, match=message):
        validate_trajectory(trajectory, start_rad=np.zeros(2), joints=JOINTS)

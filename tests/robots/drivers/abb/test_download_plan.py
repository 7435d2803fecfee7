"""A sampled trajectory becomes at most 100 points, and what that costs is measured."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.abb.download_plan import MOST_POINTS, plan_download
from robots.drivers.abb.path_tracker import PathTracker
from robots.port import Array, JointTrajectory
from tests.robots.drivers.abb.emulated_irc5 import straight

START, GOAL = np.zeros(6), np.array([1.0, -0.5, 0.2, 2.0, 0.0, -1.0])


def trajectory(position: Array, *, dt_s: float = 0.01) -> JointTrajectory:
    """Return a trajectory through these samples."""
    return JointTrajectory(dt_s=dt_s, position_rad=position, velocity_rad_s=np.gradient(position, dt_s, axis=0))


def wave(duration_s: float, hertz: float) -> JointTrajectory:
    """Two joints on a circle of 0.2 rad while a third one turns, so that no point is passed twice."""
    time_s = np.arange(round(duration_s * 100) + 1) * 0.01
    position = np.zeros((len(time_s), 6))
    position[:, 0] = 0.2 * np.sin(2.0 * np.pi * hertz * time_s)
    position[:, 1] = 0.2 * np.cos(2.0 * np.pi * hertz * time_s)
    position[:, 2] = hertz * time_s
    return trajectory(position)


def lines(points: Array, samples: int) -> Array:
    """Return straight lines between points, densely."""
    ends: list[tuple[Array, Array]] = list(pairwise(points))
    return np.vstack([np.linspace(first, then, samples) for first, then in ends])


def test_a_straight_motion_does_not_leave_its_path_and_keeps_its_speed_closely() -> None:
    plan = plan_download(straight(START, GOAL, duration_s=4.0), speed=1.0, min_duration_s=0.1)
    assert plan.deviation_rad < 1e-12
    assert plan.lag_rad < 0.003
    assert len(plan.position_rad) <= 41
    assert plan.duration_s[1:].sum() == pytest.approx(4.0)
    assert plan.duration_s.min() >= 0.1


@pytest.mark.parametrize("hertz", [0.1, 0.5, 2.0])
def test_the_measured_deviation_is_the_distance_of_the_path_from_the_lines(hertz: float) -> None:
    given_path = wave(20.0, hertz)
    plan = plan_download(given_path, speed=1.0, min_duration_s=0.1)
    assert len(plan.position_rad) <= MOST_POINTS
    dense = lines(plan.position_rad, 300)
    far = max(float(np.abs(dense - sample).max(axis=1).min()) for sample in given_path.position_rad)
    assert far <= plan.deviation_rad + 2e-4
    assert plan.deviation_rad <= 1.5 * far + 1e-6
    assert plan.deviation_rad <= plan.lag_rad + 1e-12


def test_a_path_with_too_many_curves_for_100_points_deviates_visibly() -> None:
    assert plan_download(wave(60.0, 1.0), speed=1.0, min_duration_s=0.1).deviation_rad > 0.1


def test_a_lower_speed_stretches_each_move_and_allows_finer_ones() -> None:
    fast = plan_download(wave(4.0, 1.0), speed=1.0, min_duration_s=0.2)
    slow = plan_download(wave(4.0, 1.0), speed=0.25, min_duration_s=0.2)
    assert fast.duration_s[1:].sum() == pytest.approx(4.0)
    assert slow.duration_s[1:].sum() == pytest.approx(16.0)
    assert slow.deviation_rad < fast.deviation_rad
    assert slow.duration_s.min() >= 0.2 - 1e-9


def test_a_motion_shorter_than_the_shortest_move_is_stretched_to_it() -> None:
    plan = plan_download(straight(START, 0.001 * GOAL, duration_s=0.03), speed=1.0, min_duration_s=0.1)
    assert plan.position_rad[-1] == pytest.approx(0.001 * GOAL)
    assert plan.duration_s.tolist() == [0.1, 0.1]


def test_a_single_sample_is_one_point() -> None:
    plan = plan_download(trajectory_of_one(), speed=1.0, min_duration_s=0.1)
    assert (len(plan.position_rad), plan.deviation_rad) == (1, 0.0)


def trajectory_of_one() -> JointTrajectory:
    """An arm that stays where it is."""
    return JointTrajectory(dt_s=0.01, position_rad=START[None], velocity_rad_s=START[None])


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.tuples(*[st.floats(-3.0, 3.0)] * 3), min_size=2, max_size=12),
    st.floats(0.05, 1.0),
    st.sampled_from([0.02, 0.1, 0.3]),
)
def test_any_path_keeps_its_ends_the_limits_and_its_order(
    corners: list[tuple[float, float, float]], speed: float, min_duration_s: float
) -> None:
    given_path = trajectory(lines(np.array(corners), 40))
    plan = plan_download(given_path, speed=speed, min_duration_s=min_duration_s)
    assert plan.position_rad[0].tolist() == given_path.position_rad[0].tolist()
    assert plan.position_rad[-1].tolist() == given_path.position_rad[-1].tolist()
    assert 2 <= len(plan.position_rad) <= MOST_POINTS
    assert plan.duration_s.min() >= min_duration_s - 1e-9
    assert plan.duration_s[1:].sum() >= given_path.duration_s / speed - 1e-6


def test_the_tracker_passes_a_crossing_in_the_order_of_the_path() -> None:
    """The path passes the same point twice; time tells which passage it is."""
    there = lines(np.array([[0.0], [1.0]]), 101)
    given_path = trajectory(np.vstack((there, there[::-1])))
    tracker = PathTracker(given_path)
    assert tracker.advance(np.array([0.3]), passed_s=0.3) == pytest.approx(0.0)
    assert tracker.progress == pytest.approx(30 / 201)
    tracker.advance(np.array([0.9]), passed_s=0.9)
    tracker.advance(np.array([0.2]), passed_s=1.8)
    assert tracker.progress == pytest.approx(181 / 201)
    assert tracker.advance(np.array([0.5]), passed_s=1.9) == pytest.approx(0.3)


def test_the_rest_of_a_path_begins_where_the_arm_is_and_has_its_end() -> None:
    tracker = PathTracker(straight(START, GOAL, duration_s=1.0))
    beside = 0.5 * GOAL + 0.001
    tracker.advance(beside, passed_s=0.5)
    rest = tracker.rest(beside)
    assert rest.position_rad[0].tolist() == beside.tolist()
    assert rest.position_rad[-1].tolist() == GOAL.tolist()
    assert len(rest.position_rad) == 51
    tracker.advance(GOAL, passed_s=1.0)
    assert len(tracker.rest(GOAL).position_rad) == 2

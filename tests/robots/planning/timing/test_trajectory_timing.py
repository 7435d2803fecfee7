"""Trajectories keep to speed, acceleration and jerk, to the confirmed way, rest at both ends, and touch nothing."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.planning_scenes import cases
from engine.errors import RobotError
from robots.model.registry import robot_model
from robots.model.robot_model import JointLimits
from robots.motion.joint_checks import check_speed
from robots.motion.joint_profile import plan_joints
from robots.planning.request import PathPlan
from robots.planning.timing.trajectory_timing import time_path
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array, JointTrajectory
from tests.robots.planning.motion_oracle import MotionOracle
from tests.tiers import examples

PANDA = robot_model("panda")
LIMITS = PANDA.limits
SPEED, PUSH = np.array(LIMITS.velocity_rad_s), np.array(LIMITS.acceleration_rad_s2)


def random_path(seed: int) -> Array:
    random = np.random.default_rng(seed)
    steps = random.normal(size=(int(random.integers(2, 9)), 7)) * random.choice([0.001, 0.05, 0.5])
    # Some joints stand still, some lines turn back, some waypoints are double.
    steps[:, random.random(7) < 0.3] = 0.0
    if random.random() < 0.3:
        steps[-1] = -0.7 * steps[-2]
    if random.random() < 0.3:
        steps[0] = 0.0
    return np.cumsum(steps, axis=0)


def distance_to(way: Array, points: Array) -> Array:
    """Return how far each point is from a way of straight lines."""
    a, b = way[:-1], way[1:]
    along = (b - a)[None]
    share = ((points[:, None] - a[None]) * along).sum(axis=2) / np.maximum((along**2).sum(axis=2), 1e-30)
    nearest = a[None] + np.clip(share, 0.0, 1.0)[:, :, None] * along
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def softer(share: float) -> JointLimits:
    """An arm with this share of the jerks."""
    return replace(LIMITS, jerk_rad_s3=tuple(share * jerk for jerk in LIMITS.jerk_rad_s3))


def changes(trajectory: JointTrajectory) -> tuple[Array, Array]:
    """Return accelerations and jerks between the samples, at rest before and after it."""
    velocity, dt = trajectory.velocity_rad_s, trajectory.dt_s
    push = np.diff(velocity, axis=0) / dt
    none = np.zeros((1, velocity.shape[1]))
    return push, np.diff(np.vstack((none, push, none)), axis=0) / dt


@settings(deadline=None, max_examples=examples(30, nightly=240))
@given(seed=st.integers(0, 2**32 - 1), speed=st.sampled_from([1.0, 0.3]), soft=st.sampled_from([1.0, 0.1, 0.02]))
def test_a_trajectory_keeps_to_the_limits_and_to_the_way(seed: int, speed: float, soft: float) -> None:
    way, limits = random_path(seed), softer(soft)
    found = time_path(way, limits=limits, is_free=lambda _: True, speed=speed)
    trajectory = found.trajectory
    assert np.array_equal(trajectory.position_rad[0], way[0])
    assert np.allclose(trajectory.position_rad[-1], way[-1], atol=1e-9)
    assert not trajectory.velocity_rad_s[[0, -1]].any()
    check_speed(LIMITS, PANDA.arm_joints, trajectory)
    assert (np.abs(trajectory.velocity_rad_s) <= speed * SPEED * 1.001).all()
    push, jerk = changes(trajectory)
    assert (np.abs(push) <= speed * PUSH * 0.51 + 1e-6).all()
    assert (np.abs(jerk) <= np.array(limits.jerk_rad_s3) * 1.02 + 1e-3).all()
    assert distance_to(way, trajectory.position_rad).max() <= 0.05 + 1e-6


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 2**32 - 1))
def test_where_no_corner_may_be_cut_the_arm_stops_there_and_stays_on_the_lines(seed: int) -> None:
    way = random_path(seed)
    found = time_path(way, limits=LIMITS, is_free=lambda _: False)
    assert distance_to(way, found.trajectory.position_rad).max() <= 1e-6
    check_speed(LIMITS, PANDA.arm_joints, found.trajectory)
    assert (np.abs(changes(found.trajectory)[1]) <= np.array(LIMITS.jerk_rad_s3) * 1.02).all()


@pytest.mark.parametrize("soft", [1.0, 0.1, 0.03])
def test_a_straight_line_takes_as_long_as_the_best_profile_for_it(soft: float) -> None:
    start, goal = np.zeros(7), np.array([1.0, -0.5, 0.2, 0.0, 0.8, 0.4, -1.0])
    goal[3], start[3] = -1.0, -0.5
    limits = replace(softer(soft), lower_rad=(-9.0,) * 7, upper_rad=(9.0,) * 7)
    best = plan_joints(start, goal, speed=1.0, limits=limits, joint_names=PANDA.arm_joints)
    found = time_path(np.array([start, goal]), limits=limits, is_free=lambda _: True)
    best_s = best.dt_s * (len(best.position_rad) - 1)
    assert found.duration_s == pytest.approx(best_s, rel=0.04)


def test_the_softer_an_arm_the_longer_it_takes() -> None:
    way = random_path(5)
    took = [time_path(way, limits=softer(soft), is_free=lambda _: True).duration_s for soft in (1.0, 0.1, 0.01)]
    assert took == sorted(took)
    assert took[-1] > 1.1 * took[0]


def test_rounded_corners_are_faster_than_stops() -> None:
    way = np.cumsum(np.eye(7)[[0, 1, 2, 1]] * 0.5, axis=0)
    smooth = time_path(way, limits=LIMITS, is_free=lambda _: True)
    stopping = time_path(way, limits=LIMITS, is_free=lambda _: False)
    assert smooth.stops == 0
    assert stopping.stops == 2
    assert smooth.duration_s < 0.85 * stopping.duration_s


def test_an_arm_that_is_there_already_stands() -> None:
    found = time_path(np.zeros((3, 7)), limits=LIMITS, is_free=lambda _: True)
    assert not found.trajectory.velocity_rad_s.any()


def test_a_speed_above_the_limits_is_refused() -> None:
    with pytest.raises(RobotError, match="speed 2"):
        time_path(np.zeros((2, 7)), limits=LIMITS, is_free=lambda _: True, speed=2.0)


@pytest.mark.parametrize("title", ["IRB4600, one box", "UR10, one box", "Panda, table and shelf"])
def test_the_trajectory_of_a_plan_touches_nothing(title: str) -> None:
    request = next(case.request for case in cases() if case.title == title)
    planner = ScenePlanner(check_s=2e-5)
    oracle, model = MotionOracle(request.scene, request.arm), request.scene.arm(request.arm).placement.robot()
    # Other seeds are judged in `test_scene_planner`.
    answer = planner.plan(msgspec.structs.replace(request, seed=3, speed=1.0))
    assert isinstance(answer, PathPlan), answer
    assert answer.timed is not None
    trajectory = answer.timed
    check_speed(model.limits, model.arm_joints, trajectory)
    assert np.allclose(trajectory.position_rad[[0, -1]], answer.path[[0, -1]], atol=1e-9)
    assert oracle.first_touch(trajectory.position_rad) is None

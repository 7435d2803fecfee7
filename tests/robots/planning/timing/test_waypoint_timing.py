"""A motion through waypoints is continuous, keeps to the limits, and passes each waypoint within its own distance."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from robots.motion.joint_checks import check_speed
from robots.planning.timing.trajectory_timing import longest_cut_rad
from robots.planning.timing.waypoint_timing import TimedWaypoints, time_waypoints
from robots.port import Array
from tests.robots.panda_arm import home, panda_kinematics, panda_model, played
from tests.tiers import examples

LIMITS = panda_model().limits
BLENDS_M = st.sampled_from([0.0, 0.001, 0.01, 0.05, 0.3])
CORNER = home() + np.array([[0.0] * 7, [0.5] + [0.0] * 6, [0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0]])


def tool(joints: Array) -> Array:
    return panda_kinematics().tool_pose(joints).xyz


def timed(path: Array, blends_m: list[float], *, speed: float = 0.5, speed_m_s: float | None = None) -> TimedWaypoints:
    return time_waypoints(path, blends_m=blends_m, tool_position=tool, limits=LIMITS, speed=speed, speed_m_s=speed_m_s)


def sample_at(found: TimedWaypoints, time_s: float) -> int:
    return round(time_s / found.trajectory.dt_s)


@st.composite
def paths(draw: st.DrawFn) -> tuple[Array, list[float]]:
    """Waypoints in the limits of a Panda, some of them equal to their predecessor or turning back, with blends."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    blends = draw(st.lists(BLENDS_M, min_size=1, max_size=6))
    lower, upper = np.array(LIMITS.lower_rad), np.array(LIMITS.upper_rad)
    rows = [home()]
    for _ in blends:
        step = random.normal(size=7) * random.choice([0.0, 0.01, 0.3, 0.8])
        if len(rows) > 1 and random.random() < 0.2:
            step = 0.6 * (rows[-2] - rows[-1])
        rows.append(np.clip(rows[-1] + step, lower, upper))
    return np.array(rows), [0.0, *blends]


@settings(deadline=None, max_examples=examples(40, nightly=400))
@given(path=paths(), speed=st.sampled_from([1.0, 0.2]))
def test_a_motion_is_continuous_within_the_limits_and_near_its_waypoints(
    path: tuple[Array, list[float]], speed: float
) -> None:
    waypoints, blends = path
    found = timed(waypoints, blends, speed=speed)
    trajectory = found.trajectory
    assert np.allclose(trajectory.position_rad[[0, -1]], waypoints[[0, -1]], atol=1e-6)
    assert not trajectory.velocity_rad_s[[0, -1]].any()
    check_speed(LIMITS, panda_model().arm_joints, trajectory)
    # Continuous: neither the positions nor the speeds of neighbouring samples are further apart than the limits allow.
    most_rad_s = speed * np.array(LIMITS.velocity_rad_s) * 1.001
    steps_rad = np.abs(np.diff(trajectory.position_rad, axis=0))
    assert (np.abs(played(trajectory)[1]) <= most_rad_s).all()
    assert (steps_rad <= most_rad_s * trajectory.dt_s).all()
    changes = np.abs(np.diff(trajectory.velocity_rad_s, axis=0)) / trajectory.dt_s
    assert (changes <= speed * np.array(LIMITS.acceleration_rad_s2) * 0.51 + 1e-6).all()
    assert (trajectory.position_rad >= np.array(LIMITS.lower_rad) - 1e-9).all()
    assert (trajectory.position_rad <= np.array(LIMITS.upper_rad) + 1e-9).all()
    assert list(found.passed_s) == sorted(found.passed_s)
    assert found.passed_s[-1] == pytest.approx(trajectory.duration_s)
    for waypoint, blend_m, passed_s in zip(waypoints[1:], blends[1:], found.passed_s, strict=True):
        at = sample_at(found, passed_s)
        near = trajectory.position_rad[max(0, at - 3) : at + 4]
        # The samples are 2 ms apart, so the nearest one may be a little beside the middle of the blend.
        assert min(np.linalg.norm(tool(row) - tool(waypoint)) for row in near) <= blend_m + 3e-4


@settings(deadline=None, max_examples=examples(20, nightly=200))
@given(path=paths(), speed_m_s=st.sampled_from([0.05, 0.2]))
def test_the_tool_keeps_to_its_speed(path: tuple[Array, list[float]], speed_m_s: float) -> None:
    found = timed(*path, speed=1.0, speed_m_s=speed_m_s)
    points = np.array([tool(row) for row in found.trajectory.position_rad])
    speeds = np.linalg.norm(np.diff(points, axis=0), axis=1) / found.trajectory.dt_s
    assert speeds.max() <= speed_m_s * 1.01


def test_the_tool_is_not_slower_than_it_may_be() -> None:
    found = timed(CORNER, [0.0, 0.01, 0.0], speed=1.0, speed_m_s=0.1)
    points = np.array([tool(row) for row in found.trajectory.position_rad])
    speeds = np.linalg.norm(np.diff(points, axis=0), axis=1) / found.trajectory.dt_s
    assert speeds.max() > 0.09


def test_the_arm_passes_a_blended_corner_and_rests_at_one_without_a_blend() -> None:
    for blend_m, is_moving in ((0.02, True), (0.0, False)):
        found = timed(CORNER, [0.0, blend_m, 0.0])
        at = sample_at(found, found.passed_s[0])
        slowest = np.abs(found.trajectory.velocity_rad_s[at - 2 : at + 3]).max(axis=1).min()
        assert bool(slowest > 0.1) is is_moving


def test_a_blend_uses_the_distance_that_it_may() -> None:
    for blend_m in (0.003, 0.01):
        found = timed(CORNER, [0.0, blend_m, 0.0])
        distances = [np.linalg.norm(tool(row) - tool(CORNER[1])) for row in found.trajectory.position_rad]
        assert blend_m * 0.9 < min(distances) <= blend_m + 1e-6


def test_the_wider_the_blend_the_sooner_it_ends() -> None:
    took = [timed(CORNER, [0.0, blend_m, 0.0]).trajectory.duration_s for blend_m in (0.0, 0.003, 0.03)]
    assert took == sorted(took, reverse=True)
    assert took[-1] < 0.9 * took[0]


def test_where_the_path_turns_back_the_arm_rests_whatever_the_blend() -> None:
    there_and_back = CORNER[[0, 1, 0]]
    found = timed(there_and_back, [0.0, 0.3, 0.0])
    at = sample_at(found, found.passed_s[0])
    assert np.abs(found.trajectory.velocity_rad_s[at]).max() < 0.02
    assert longest_cut_rad(np.array([1.0, 0.0]), np.array([-1.0, 0.0]), (1.0, 1.0)) == 0.0


def test_waypoints_at_the_start_take_no_time() -> None:
    found = timed(CORNER[[0, 0, 0]], [0.0, 0.1, 0.1])
    assert found.passed_s == (found.trajectory.duration_s,) * 2
    assert not found.trajectory.velocity_rad_s.any()


@pytest.mark.parametrize(
    ("speed", "speed_m_s", "message"),
    [
        (0.001, None, "the speed cannot be 0.001"),
        (float("nan"), None, "the speed cannot be nan"),
        (0.5, 1e-5, "s with a tool speed of 1e-05 m/s"),
        (0.5, float("nan"), "the motion would take nan"),
    ],
)
def test_a_motion_that_would_take_too_long_is_refused(speed: float, speed_m_s: float | None, message: str) -> None:
    with pytest.raises(RobotError, match=message):
        timed(CORNER, [0.0, 0.02, 0.0], speed=speed, speed_m_s=speed_m_s)


def test_a_path_that_would_take_too_long_is_refused_before_it_is_timed() -> None:
    with pytest.raises(RobotError, match="the motion would take 6"):
        timed(np.tile(CORNER, (900, 1)), [0.0] * 2700, speed=0.01)

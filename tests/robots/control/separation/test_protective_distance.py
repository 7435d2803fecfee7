"""The protective separation distance: its terms add up as in ISO/TS 15066, and no stop is longer than it says."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.control.separation.motion_speed import MotionSpeed
from robots.control.separation.protective_distance import StopModel, protective_distance_m
from robots.control.separation.separation_monitor import STOP_SHARE
from robots.port import Array, JointTrajectory, SeparationRule
from robots.vision.known_geometry import ArmConfiguration
from robots.vision.occupancy.arm_body import ArmBody
from robots.workspace.separation_measurement import link_extents_m
from tests.robots.panda_arm import configurations, panda_kinematics, panda_model
from tests.robots.sim.sim_cell import LEFT, smooth

LIMITS = panda_model().limits
STOPS = StopModel(LIMITS)
RULE = SeparationRule(reaction_s=0.2, delay_s=0.08, intrusion_m=0.1, uncertainty_m=0.03)
STEP_S = 0.001


def test_the_terms_add_up() -> None:
    """1.6 (0.2 + 0.3) + 0.5 * 0.2 + 0.09 + 0.1 + 0.03 = 1.12 m; at rest 1.6 * 0.2 + 0.13 = 0.45 m."""
    required_m = protective_distance_m(
        RULE,
        reaction_s=0.2,
        speed_m_s=np.array([0.0, 0.5]),
        stop_s=np.array([0.0, 0.3]),
        stop_m=np.array([0.0, 0.09]),
    )
    assert required_m.tolist() == pytest.approx([0.45, 1.12])


def test_a_faster_arm_takes_longer_to_stop_and_one_at_rest_no_time() -> None:
    times_s = STOPS.time_s(np.array(LIMITS.velocity_rad_s), np.linspace(0.0, 1.0, 11))
    assert times_s[0] == 0.0
    assert (np.diff(times_s) > 0.0).all()


@pytest.mark.parametrize("speed_rad_s", [0.2, 0.45, 2.0])
def test_a_stop_takes_as_long_as_its_deceleration_needs_to_lose_the_speed(speed_rad_s: float) -> None:
    """It rises with 85 % of the jerk limit to at most 90 % of the acceleration limit, and fades half as fast."""
    limits = dataclasses.replace(
        LIMITS,
        lower_rad=(-3.0,),
        upper_rad=(3.0,),
        velocity_rad_s=(2.0,),
        acceleration_rad_s2=(4.0,),
        jerk_rad_s3=(40.0,),
    )
    time_s = float(StopModel(limits).time_s(np.array([speed_rad_s]), np.array([1.0]))[0])
    stop_s, rise, fade = (time_s - 0.02) / 1.35, 0.85 * 40.0, 0.5 * 0.85 * 40.0
    t = np.linspace(0.0, stop_s, 20001)
    deceleration = np.minimum(np.minimum(rise * t, fade * (stop_s - t)), 0.9 * 4.0)
    assert float(np.trapezoid(deceleration, t)) == pytest.approx(speed_rad_s, rel=1e-3)


def _bent(first: Array, second: Array, third: Array) -> JointTrajectory:
    """Return a motion from `first` to `third` that passes by `second`, as fast as the limits allow."""
    u = np.linspace(0.0, 1.0, 401)[:, None]
    share, rate = 10 * u**3 - 15 * u**4 + 6 * u**5, 30 * u**2 - 60 * u**3 + 30 * u**4
    position = (1 - share) ** 2 * first + 2 * share * (1 - share) * second + share**2 * third
    slope = rate * (2 * (1 - share) * (second - first) + 2 * share * (third - second))
    bend, jerk = np.gradient(slope, u[1, 0], axis=0), np.gradient(np.gradient(slope, u[1, 0], axis=0), u[1, 0], axis=0)
    duration_s = max(
        float((np.abs(slope).max(axis=0) / np.array(LIMITS.velocity_rad_s)).max()),
        float(np.sqrt((np.abs(bend).max(axis=0) / np.array(LIMITS.acceleration_rad_s2)).max())),
        float(np.cbrt((np.abs(jerk).max(axis=0) / np.array(LIMITS.jerk_rad_s3)).max())),
        0.1,
    )
    return JointTrajectory(dt_s=duration_s / 400, position_rad=position, velocity_rad_s=slope / duration_s)


@settings(deadline=None, max_examples=60)
@given(
    st.tuples(configurations(0.2), configurations(0.2), configurations(0.2)),
    st.booleans(),
    st.floats(0.05, 0.9),
    st.floats(0.05, 1.0),
)
def test_no_stop_takes_longer_or_leads_farther(
    through: tuple[Array, Array, Array], bent: bool, at: float, pace: float
) -> None:
    """Anywhere on straight and bent paths at the limits of the joints, from any pace."""
    first, second, third = through
    trajectory = _bent(first, second, third) if bent else smooth(first, third, 0.1)
    playback = TrajectoryPlayback(
        trajectory, acceleration_rad_s2=np.array(LIMITS.acceleration_rad_s2), jerk_rad_s3=np.array(LIMITS.jerk_rad_s3)
    )
    kinematics = panda_kinematics().twin()
    speed = MotionSpeed(playback, kinematics=kinematics)
    while not speed.known:
        speed.look()
    stop_s = float(STOPS.time_s(speed.joints_rad_s, np.array([pace]))[0])
    fastest_m_s = pace * speed.fastest_m_s(link_extents_m(panda_model()))
    while playback.progress < at and not playback.at_end:
        playback.step(STEP_S, target_pace=pace)
    steps, tool = 0, kinematics.tool_pose(playback.position).xyz
    passed_m = 0.0
    while not playback.stopped:
        playback.step(STEP_S, target_pace=0.0)
        now = kinematics.tool_pose(playback.position).xyz
        passed_m += float(np.linalg.norm(now - tool))
        steps, tool = steps + 1, now
    assert steps * STEP_S <= stop_s
    assert passed_m <= STOP_SHARE * fastest_m_s * stop_s + 1e-3


@settings(deadline=None, max_examples=40)
@given(configurations(), configurations())
def test_no_point_of_the_arm_is_faster_than_said(start: Array, goal: Array) -> None:
    """Compared with the spheres that cover the arm, at two near instants, along the whole path."""
    trajectory = smooth(start, goal, 1.0)
    playback = TrajectoryPlayback(
        trajectory, acceleration_rad_s2=np.array(LIMITS.acceleration_rad_s2), jerk_rad_s3=np.array(LIMITS.jerk_rad_s3)
    )
    speed = MotionSpeed(playback, kinematics=panda_kinematics().twin())
    while not speed.known:
        speed.look()
    body, said_m_s = ArmBody(LEFT), speed.fastest_m_s(link_extents_m(panda_model()))
    for row in range(0, len(trajectory.position_rad), 25):
        here = trajectory.position_rad[row]
        later = here + 1e-6 * trajectory.velocity_rad_s[row]
        balls, moved = (body.balls(ArmConfiguration(joints=tuple(q.tolist()))) for q in (here, later))
        measured = np.linalg.norm(moved[:, :3] - balls[:, :3], axis=1) / 1e-6
        assert measured.max() <= said_m_s * 1.02 + 1e-3

"""The tool jogged by velocities: straight, slower where a joint is in the way, calm near singularities."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.arm_state import ArmState
from robots.control.generators.damped_inverse import joint_velocity
from robots.control.generators.tool_jogging import ToolJogGenerator
from robots.port import Array
from tests.robots.control.limit_watch import STEP_S, LimitWatch, limits
from tests.robots.control.plane_arm import PlaneKinematics, plane_state
from tests.robots.panda_arm import home, panda_kinematics

BENT = np.array([0.3, 1.2])


class Jog:
    """A jogged plane arm whose limits are watched."""

    def __init__(self, start: Array, *, watchdog_s: float = 0.1) -> None:
        self.state = plane_state()
        self.jogging = ToolJogGenerator(limits=limits(), start=start, watchdog_s=watchdog_s)
        self.watch = LimitWatch(limits(), self.jogging)

    def tip(self) -> Array:
        return PlaneKinematics().tool_pose(self.jogging.position).xyz

    def run(self, x_m_s: float, y_m_s: float, periods: int, *, pace: float = 1.0) -> None:
        for _ in range(periods):
            self.jogging.receive(np.array([x_m_s, y_m_s, 0.0, 0.0, 0.0, 0.0]))
            self.silence(1, pace=pace)

    def silence(self, periods: int, *, pace: float = 1.0) -> None:
        for _ in range(periods):
            self.jogging.step(STEP_S, target_pace=pace, state=self.state)
            self.watch.look()


def test_the_tool_goes_straight_as_fast_as_commanded() -> None:
    jog = Jog(BENT)
    start = jog.tip()
    jog.run(0.0, 0.2, 400)
    middle = jog.tip()
    jog.run(0.0, 0.2, 400)
    assert abs((jog.tip() - middle)[1] - 0.08) < 1e-3
    assert abs((jog.tip() - start)[0]) < 2e-4


def test_a_panda_keeps_its_orientation_and_line_while_it_is_jogged() -> None:
    kinematics = panda_kinematics()
    state = ArmState(kinematics)
    jogging = ToolJogGenerator(limits=kinematics.limits, start=home(), watchdog_s=0.1)
    start = kinematics.tool_pose(jogging.position)
    for _ in range(800):
        jogging.receive(np.array([0.05, -0.1, -0.1, 0.0, 0.0, 0.0]))
        jogging.step(STEP_S, target_pace=1.0, state=state)
    end = kinematics.tool_pose(jogging.position)
    way = end.xyz - start.xyz
    assert np.linalg.norm(np.cross(way, np.array([1.0, -2.0, -2.0]) / 3.0)) < 2e-4
    assert 0.1 < np.linalg.norm(way) < 0.12
    assert start.angle_rad(end) < 1e-3


def test_where_a_joint_would_be_too_fast_the_tool_is_slower_on_the_same_line() -> None:
    jog = Jog(BENT, watchdog_s=0.1)
    start = jog.tip()
    jog.run(0.0, 3.0, 300)
    fastest = np.abs(np.array(jog.watch.velocities)).max()
    way = jog.tip() - start
    assert 1.9 < fastest <= 2.0
    assert abs(way[0]) < 0.01 * abs(way[1])


def test_at_a_joint_limit_the_tool_stops_on_its_line_and_comes_back() -> None:
    jog = Jog(np.array([1.2, 0.9]))
    # On a circle about the shoulder only that joint moves, up to its limit.
    stuck = 0
    for _ in range(3000):
        x, y, _ = jog.tip()
        jog.run(-0.5 * y, 0.5 * x, 1)
        stuck += int(jog.jogging.position[0] > 1.99)
    assert stuck > 500
    assert abs(jog.jogging.position[1] - 0.9) < 0.01
    jog.run(0.3, 0.0, 600)
    assert jog.jogging.position[0] < 1.9


def test_stretched_out_the_arm_comes_to_rest_calmly() -> None:
    jog = Jog(np.array([0.0, 0.3]))
    jog.run(0.3, 0.0, 2000)
    assert jog.tip()[0] > 0.995
    late = np.array(jog.watch.velocities[-500:])
    assert np.abs(late).max() < 0.05


def test_near_a_singularity_the_damped_direction_fades_and_the_other_one_does_not() -> None:
    _, jacobian = PlaneKinematics().tool_pose_and_jacobian(np.array([0.0, 1e-4]))
    outward = joint_velocity(jacobian[:3], np.array([0.1, 0.0, 0.0]))
    assert np.abs(outward).max() < 0.02
    _, bent = PlaneKinematics().tool_pose_and_jacobian(BENT)
    wanted = bent @ np.array([0.4, -0.7])
    assert np.allclose(joint_velocity(bent, wanted), [0.4, -0.7], atol=1e-12)


def test_silence_and_a_hold_bring_it_to_rest() -> None:
    for pace in (1.0, 0.0):
        jog = Jog(BENT)
        jog.run(-0.2, 0.1, 400)
        jog.silence(600, pace=pace)
        assert jog.jogging.stopped


@settings(deadline=None, max_examples=25)
@given(
    st.lists(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.integers(1, 250)), min_size=1, max_size=6),
    st.tuples(st.floats(-1.9, 1.9), st.floats(-1.9, 1.9)),
)
def test_whatever_is_sent_from_wherever_the_joints_keep_their_limits(
    sent: list[tuple[float, float, int]], start: tuple[float, float]
) -> None:
    jog = Jog(np.array(start))
    for x_m_s, y_m_s, periods in sent:
        jog.run(x_m_s, y_m_s, periods)


@pytest.mark.parametrize("size", [1e6, 1e160, 1.7e308])
def test_a_twist_beyond_all_sense_is_taken_as_a_fast_one_in_its_direction(size: float) -> None:
    kinematics = panda_kinematics()
    state = ArmState(kinematics)
    jogging = ToolJogGenerator(limits=kinematics.limits, start=home(), watchdog_s=0.1)
    watch = LimitWatch(kinematics.limits, jogging)
    start = kinematics.tool_pose(home()).xyz
    for _ in range(100):
        jogging.receive(np.array([0.0, size, -size, 0.0, 0.0, 0.0]))
        jogging.step(STEP_S, target_pace=1.0, state=state)
        watch.look()
    way = kinematics.tool_pose(jogging.position).xyz - start
    assert way / np.linalg.norm(way) == pytest.approx([0.0, 0.5**0.5, -(0.5**0.5)], abs=0.02)

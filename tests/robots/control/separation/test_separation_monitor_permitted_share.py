"""The permitted share of speed: what ages, starts, rises and forgets, without an arm."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robots.control.generators.guiding import GuidingGenerator
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.control.separation.motion_speed import MotionSpeed
from robots.control.separation.separation_monitor import SeparationMonitor
from robots.port import MeasuredSeparation, PermittedSpeed, SeparationRule
from robots.workspace.separation_measurement import link_extents_m
from tests.robots.panda_arm import home, panda_kinematics, panda_model
from tests.robots.sim.sim_cell import smooth

RULE = SeparationRule(reaction_s=0.2, delay_s=0.08, intrusion_m=0.1, uncertainty_m=0.03)
AT_REST_M = 1.6 * 0.2 + 0.1 + 0.03
LIMITS = panda_model().limits
EXTENTS_M = link_extents_m(panda_model())
STEP_S = 0.001
NOTHING = PermittedSpeed(share=0.0, speed_m_s=0.0)


class Motion:
    """A monitor, and a motion whose speeds are known to it."""

    def __init__(self) -> None:
        self.monitor = SeparationMonitor(RULE, kinematics=panda_kinematics().twin())
        self.generator = self.new_generator()
        for _ in range(12):
            assert self.share() == 0.0

    def new_generator(self) -> TrajectoryPlayback:
        """Return another motion."""
        goal = home() + np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        return TrajectoryPlayback(
            smooth(home(), goal, 1.0),
            acceleration_rad_s2=np.array(LIMITS.acceleration_rad_s2),
            jerk_rad_s3=np.array(LIMITS.jerk_rad_s3),
        )

    def share(self) -> float:
        """Return what the next period permits."""
        return self.monitor.permitted_share(STEP_S, self.generator)

    def measure(self, distance_m: float, *, age_s: float = 0.05) -> float:
        """Take a measurement; return what the next period permits."""
        self.monitor.take(MeasuredSeparation(distance_m=distance_m, age_s=age_s, extents_m=EXTENTS_M))
        return self.share()

    def permit(self, share: float) -> float:
        """Take a measurement of nobody whose age permits a share; return what the next period permits."""
        return self.measure(math.inf, age_s=RULE.reaction_s * (2.0 - share) - RULE.delay_s - STEP_S)


def test_a_measurement_without_anybody_permits_less_with_its_age_and_nothing_at_twice_the_regular_one() -> None:
    motion = Motion()
    assert motion.permit(0.5) == pytest.approx(0.5)
    assert [motion.share() for _ in range(100)][-1] == 0.0
    assert Motion().permit(-0.1) == 0.0
    assert Motion().measure(math.inf, age_s=0.12 - STEP_S) == 1.0


def test_each_measurement_counts_even_where_its_age_does_not() -> None:
    """Younger than the regular reaction time, all ages permit the same."""
    motion = Motion()
    assert motion.measure(math.inf) == 1.0
    assert motion.measure(AT_REST_M - 0.01) == 0.0
    assert motion.share() == 0.0
    assert motion.monitor.permitted.share == 0.0
    assert motion.measure(AT_REST_M + 3.0, age_s=0.06) > 0.0
    assert motion.monitor.permitted.share == 1.0


def test_each_period_without_a_measurement_counts_with_its_length() -> None:
    motion = Motion()
    motion.permit(0.5)
    shares = [motion.share() for _ in range(3)]
    assert shares == pytest.approx([0.495, 0.49, 0.485])


def test_one_at_rest_starts_from_five_percent_and_one_in_motion_stops_below_two() -> None:
    motion = Motion()
    assert motion.permit(0.04) == 0.0
    assert motion.permit(0.06) == pytest.approx(0.06)
    assert motion.permit(0.03) == pytest.approx(0.03)
    assert motion.permit(0.01) == 0.0
    assert motion.permit(0.04) == 0.0


def test_a_motion_may_start_with_any_share_and_rises_slowly_afterwards_but_falls_at_once() -> None:
    motion = Motion()
    assert motion.permit(0.3) == pytest.approx(0.3)
    assert motion.permit(1.0) == pytest.approx(0.3 + 0.8 * STEP_S)
    assert motion.permit(1.0) == pytest.approx(0.3 + 1.6 * STEP_S)
    assert motion.permit(0.1) == pytest.approx(0.1)
    motion.generator = motion.new_generator()
    for _ in range(12):
        motion.share()
    assert motion.permit(1.0) == pytest.approx(1.0)


def test_the_distance_at_rest_permits_nothing_and_the_protective_distance_everything() -> None:
    motion = Motion()
    assert motion.measure(AT_REST_M) == 0.0
    protective_m = motion.monitor.permitted.protective_m
    assert protective_m > AT_REST_M + 0.1
    assert 0.0 < Motion().measure((AT_REST_M + protective_m) / 2.0) < 1.0
    assert Motion().measure(protective_m) == pytest.approx(1.0)


def test_the_permitted_speed_is_that_of_the_fastest_point() -> None:
    motion = Motion()
    speed = MotionSpeed(motion.generator, kinematics=panda_kinematics().twin())
    while not speed.known:
        speed.look()
    fastest_m_s = speed.fastest_m_s(EXTENTS_M)
    assert fastest_m_s > 0.5
    assert SeparationMonitor(RULE, kinematics=panda_kinematics().twin()).permitted == NOTHING
    assert motion.monitor.permitted == NOTHING
    motion.permit(0.5)
    assert motion.monitor.permitted.speed_m_s == pytest.approx(0.5 * fastest_m_s)
    motion.permit(1.0)
    assert motion.monitor.permitted.speed_m_s == pytest.approx(fastest_m_s)
    motion.monitor.forget()
    for _ in range(20):
        motion.share()
    assert motion.monitor.permitted == NOTHING


def test_a_longer_part_in_the_tool_permits_less_speed_at_once() -> None:
    motion = Motion()
    before = motion.measure(0.8)
    longer = (*EXTENTS_M[:-1], EXTENTS_M[-1] + 0.5)
    motion.monitor.take(MeasuredSeparation(distance_m=0.8, age_s=0.05, extents_m=longer))
    assert motion.share() < before - 0.05


def test_without_a_motion_or_after_a_restore_nothing_is_permitted_until_it_is_measured_again() -> None:
    motion = Motion()
    motion.permit(0.3)
    assert motion.monitor.permitted_share(STEP_S, None) == 0.0
    motion.permit(0.3)
    motion.monitor.forget()
    assert [motion.share() for _ in range(20)] == [0.0] * 20
    assert motion.monitor.permitted.share == 0.0


def test_who_guides_an_arm_touches_it() -> None:
    monitor = SeparationMonitor(RULE, kinematics=panda_kinematics().twin())
    guiding = GuidingGenerator(limits=LIMITS, start=home(), measured=home())
    assert monitor.permitted_share(STEP_S, guiding) == 1.0

"""Separation monitoring in the loop of a simulated arm: all motions follow the measured distance, down to rest."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from robots.control.commanding.arm_commands import (
    FollowTrajectory,
    MeasureSeparation,
    Setpoint,
    StartGuiding,
    StartStream,
)
from robots.control.motion_event import SetPointJumped
from robots.port import ContactCondition, MeasuredSeparation, MotionEnd, PermittedSpeed, SeparationRule, Tolerance
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import CellModel, build_cell
from robots.workspace.separation_measurement import link_extents_m
from tests.robots.sim.sim_cell import HOME, PANDA, one_arm, smooth
from tests.robots.sim.stepped import SteppedArm

RULE = SeparationRule(reaction_s=0.2, delay_s=0.08, intrusion_m=0.1, uncertainty_m=0.03)
AT_REST_M = RULE.hand_speed_m_s * RULE.reaction_s + RULE.intrusion_m + RULE.uncertainty_m
"""Nearer than that nothing may move."""
EXTENTS_M = link_extents_m(PANDA)
GOAL = HOME + np.array([1.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
_PERIOD_S = 0.02


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(msgspec.structs.replace(one_arm(), separation=RULE))


@pytest.fixture(name="arm")
def _arm(cell: CellModel) -> SteppedArm:
    return SteppedArm(cell)


def _measure(arm: SteppedArm, distance_m: float, *, age_s: float = 0.05) -> None:
    measured = MeasuredSeparation(distance_m=distance_m, age_s=age_s, extents_m=EXTENTS_M)
    arm.apply(MeasureSeparation(arm="left", measured=measured))


def _run(arm: SteppedArm, seconds: float, distance_m: float) -> float:
    """Let time pass with people at a distance; return the greatest speed of the tool and of any joint set point."""
    fastest = 0.0
    for _ in range(round(seconds / _PERIOD_S)):
        _measure(arm, distance_m)
        before = arm.control.motion.position.copy()
        arm.run(_PERIOD_S)
        fastest = max(fastest, float(np.abs(arm.control.motion.position - before).max()) / _PERIOD_S)
    return fastest


def _permitted(arm: SteppedArm) -> PermittedSpeed:
    values = arm.simulation.layout.new_array()
    arm.simulation.write_snapshot(values)
    return SimSnapshot(arm.simulation.layout, values).permitted("left")


def _jumps(arm: SteppedArm) -> list[SetPointJumped]:
    return [event for event in arm.events if isinstance(event, SetPointJumped)]


def test_without_a_measurement_nothing_moves(arm: SteppedArm) -> None:
    arm.follow(GOAL, 1.0)
    arm.run(1.0)
    assert np.abs(arm.control.motion.position - HOME).max() < 1e-9
    _run(arm, 2.0, math.inf)
    assert arm.until_finished().end is MotionEnd.REACHED


def test_with_nobody_measured_a_motion_is_as_fast_as_ever(arm: SteppedArm, cell: CellModel) -> None:
    free = SteppedArm(build_cell(one_arm()))
    free.follow(GOAL, 1.5)
    free.run(0.75)
    arm.follow(GOAL, 1.5)
    _measure(arm, math.inf)
    _run(arm, 0.8, math.inf)
    assert arm.control.motion.position[0] >= free.control.motion.position[0]


def test_the_speed_falls_with_the_distance_to_rest_and_rises_again(arm: SteppedArm) -> None:
    arm.follow(GOAL, 2.0)
    _run(arm, 0.8, 3.0)
    speeds = [_run(arm, 0.1, 3.0)]
    for distance_m in (0.7, 0.55):
        _run(arm, 0.3, distance_m)
        speeds.append(_run(arm, 0.1, distance_m))
    assert speeds[0] > speeds[1] > speeds[2] > 0.0
    _run(arm, 0.5, AT_REST_M - 0.01)
    assert _run(arm, 0.5, AT_REST_M - 0.01) == 0.0
    assert _permitted(arm).share == 0.0
    assert _run(arm, 0.5, 0.8) > 0.0
    _run(arm, 8.0, math.inf)
    assert arm.until_finished().end is MotionEnd.REACHED
    assert not _jumps(arm)


def test_the_fastest_point_is_no_faster_than_permitted(arm: SteppedArm) -> None:
    arm.follow(GOAL, 1.0)
    for distance_m in (1.5, 1.0, 0.8, 0.6):
        _run(arm, 0.4, distance_m)
        before = arm.tool_xyz.copy()
        _run(arm, 0.1, distance_m)
        measured_m_s = float(np.linalg.norm(arm.tool_xyz - before)) / 0.1
        assert measured_m_s <= _permitted(arm).speed_m_s + 0.01


def test_a_measurement_that_grows_old_stops_the_arm_and_the_next_one_lets_it_go_on(arm: SteppedArm) -> None:
    arm.follow(GOAL, 3.0)
    assert _run(arm, 0.5, 3.0) > 0.1
    arm.run(2.5)
    before = arm.control.motion.position.copy()
    arm.run(0.5)
    assert (arm.control.motion.position == before).all()
    assert _run(arm, 0.5, 3.0) > 0.1
    assert not _jumps(arm)


@pytest.mark.parametrize("distance_m", [0.9, 1.4, 2.0])
@pytest.mark.parametrize("at_s", [0.2, 0.5, 0.8])
def test_who_comes_at_the_speed_of_a_hand_is_met_by_an_arm_at_rest(
    arm: SteppedArm, distance_m: float, at_s: float
) -> None:
    """The hand heads for the arm and the arm for the hand; each measurement is as late as the rule allows."""
    arm.follow(GOAL, 1.0)
    _run(arm, at_s, distance_m)
    late_s = RULE.reaction_s - RULE.delay_s
    seen = [distance_m] * round(late_s / _PERIOD_S)
    true_m, tool = distance_m, arm.tool_xyz.copy()
    while true_m > 0.0:
        _measure(arm, seen.pop(0), age_s=late_s)
        arm.run(_PERIOD_S)
        now = arm.tool_xyz.copy()
        true_m -= RULE.hand_speed_m_s * _PERIOD_S + float(np.linalg.norm(now - tool))
        tool = now
        seen.append(true_m)
    assert np.abs(arm.sample.velocity_rad_s).max() < 0.01
    assert not _jumps(arm)


def test_a_jog_and_a_guarded_motion_stop_too(arm: SteppedArm) -> None:
    arm.apply(StartStream(arm="left", motion=1, kind="joint_velocity", watchdog_s=10.0))
    arm.apply(Setpoint(motion=1, arm="left", values=(0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)))
    assert _run(arm, 0.5, math.inf) > 0.2
    _run(arm, 0.6, AT_REST_M)
    assert _run(arm, 0.3, AT_REST_M) == 0.0
    arm.control.motion.cancel(1)
    arm.until_finished(1)
    way = smooth(arm.sample.desired_rad.copy(), HOME, 2.0)
    until = ContactCondition(force_n=20.0, direction=(0.0, 0.0, 0.0))
    arm.apply(FollowTrajectory(arm="left", motion=2, trajectory=way, tolerance=Tolerance(), until=until))
    assert _run(arm, 0.3, math.inf) > 0.0
    _run(arm, 0.6, AT_REST_M)
    assert _run(arm, 0.3, AT_REST_M) == 0.0
    assert not _jumps(arm)


def test_who_guides_the_arm_may_touch_it(arm: SteppedArm) -> None:
    arm.apply(StartGuiding(arm="left", motion=1, damping=0.0))
    _run(arm, 0.1, 0.0)
    start = arm.tool_xyz.copy()
    arm.push((0.0, 15.0, 0.0), 0.5)
    _run(arm, 0.5, 0.0)
    assert np.linalg.norm(arm.tool_xyz - start) > 0.02

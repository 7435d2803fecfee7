"""The reach of arms: what is told is reached, little is missed, and finer grids contain coarser ones."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.inverse_kinematics.reach_map import reach_levels
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.transform import RigidTransform

STEP_M = 0.3
# The z axis of the tool points downwards.
DOWN = (1.0, 0.0, 0.0, 0.0)


def arm(name: str) -> ArmKinematics:
    return ArmKinematics(robot_model(name), base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))


def reached(kinematics: ArmKinematics, xyz: tuple[float, float, float]) -> bool:
    """Whether the patient search of the solver finds a way."""
    goal = RigidTransform.of(xyz, DOWN)
    seed = np.array(kinematics.model.home_rad)
    try:
        InverseKinematicsSolver(kinematics).nearest(goal, seed=seed, match=PoseMatch.AXIS)
    except RobotError:
        return False
    return True


@pytest.mark.parametrize("name", ["ur10", "panda"])
def test_what_is_reported_is_reached_and_little_is_missed(name: str) -> None:
    """Against the solver, which searches for long where nothing is near."""
    kinematics = arm(name)
    *_, last = reach_levels(kinematics, step_m=STEP_M, direction="down")
    told = {point.xyz for point in last.points}
    assert all(reached(kinematics, xyz) for xyz in told)
    # The points around those that are told: at the border most would be missed.
    steps = [(STEP_M * (axis == 0), STEP_M * (axis == 1), STEP_M * (axis == 2)) for axis in range(3)]
    around = {
        (round(x + s * dx, 6), round(y + s * dy, 6), round(z + s * dz, 6))
        for x, y, z in told
        for dx, dy, dz in steps
        for s in (-1, 1)
    } - told
    known = {tuple(round(each, 4) for each in xyz) for xyz in told}
    missed = [xyz for xyz in around if tuple(round(e, 4) for e in xyz) not in known and reached(kinematics, xyz)]
    assert len(missed) <= 0.03 * len(told)


def test_a_finer_level_has_the_points_of_the_coarser_one() -> None:
    levels = list(reach_levels(arm("panda"), step_m=STEP_M, direction="any"))
    assert [level.step_m for level in levels] == pytest.approx([4 * STEP_M, 2 * STEP_M, STEP_M])
    for coarse, fine in pairwise(levels):
        assert {point.xyz for point in coarse.points} <= {point.xyz for point in fine.points}
    assert (levels[-1].left, levels[-1].directions) == (0, 12)
    assert all(0.0 < point.share <= 1.0 and point.manipulability > 0.0 for point in levels[-1].points)
    assert any(point.share < 1.0 for point in levels[-1].points)


def test_it_is_the_same_each_time() -> None:
    first, again = (list(reach_levels(arm("ur10"), step_m=0.5, direction="down")) for _ in range(2))
    assert first == again


def test_an_arm_that_cannot_turn_its_tool_has_its_positions() -> None:
    *_, last = reach_levels(arm("servo_arm"), step_m=0.1, direction="any")
    assert last.directions == 1

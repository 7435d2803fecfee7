"""Inverse kinematics of the Panda."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from engine.errors import RobotError
from robots.model.inverse_kinematics import (
    ANGLE_TOLERANCE_RAD,
    POSITION_TOLERANCE_M,
    InverseKinematics,
)
from robots.model.rigid import Rigid
from robots.port import Array
from tests.robots.panda_arm import configurations, home, panda_kinematics, panda_model

LIMITS = panda_model().limits
DOWN = (1.0, 0.0, 0.0, 0.0)


@settings(max_examples=25, deadline=None)
@given(configurations(), configurations())
def test_every_reachable_pose_is_reached_within_the_limits(joints: Array, seed: Array) -> None:
    """From wherever the arm is."""
    kinematics = panda_kinematics()
    target = kinematics.tool_pose(joints)
    found = InverseKinematics(kinematics).nearest(target, seed=seed)
    pose = kinematics.tool_pose(found)
    assert pose.distance_m(target) <= POSITION_TOLERANCE_M
    assert pose.angle_rad(target) <= ANGLE_TOLERANCE_RAD
    assert (found >= np.array(LIMITS.lower_rad)).all()
    assert (found <= np.array(LIMITS.upper_rad)).all()


@settings(max_examples=15, deadline=None)
@given(configurations(margin_rad=0.3))
def test_a_nearby_pose_is_reached_by_a_small_motion(joints: Array) -> None:
    """The elbow stays where it is, unless the arm is next to a singularity."""
    kinematics = panda_kinematics()
    if kinematics.dexterity(joints) < 0.1:
        return
    here = kinematics.tool_pose(joints)
    there = Rigid(xyz=here.xyz + 0.005, xyzw=here.xyzw)
    try:
        found = InverseKinematics(kinematics).nearest(there, seed=joints)
    except RobotError:
        return  # the random pose was at the rim of the workspace
    assert np.abs(found - joints).max() < 0.2


def test_the_same_request_has_the_same_answer() -> None:
    """Restarts are seeded by the request."""
    target = Rigid.of((-0.1, -0.3, 0.2), (0.9, 0.3, 0.1, 0.2))
    first, second = (InverseKinematics(panda_kinematics()).nearest(target, seed=home()) for _ in range(2))
    assert (first == second).all()


@pytest.mark.parametrize(
    ("xyz", "xyzw", "words"),
    [
        ((1.2, 0.0, 0.4), DOWN, r"\(1.200, 0.000, 0.400\) is out of reach by 0\.8\d\d m"),
        ((0.2, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0), r"not in this orientation: .* with panda_joint\d at its \w+ limit"),
    ],
)
def test_an_unreachable_pose_tells_what_is_missing(
    xyz: tuple[float, float, float], xyzw: tuple[float, float, float, float], words: str
) -> None:
    """By how far, or which joint is at its limit."""
    with pytest.raises(RobotError, match=words):
        InverseKinematics(panda_kinematics()).nearest(Rigid.of(xyz, xyzw), seed=home())

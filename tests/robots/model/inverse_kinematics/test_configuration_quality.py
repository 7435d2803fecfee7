"""Singularities are recognised, named where the family of the arm is known, and put in words."""

from __future__ import annotations

import numpy as np
import pytest

from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.port import Array
from tests.robots.model.inverse_kinematics.ik_arms import arm

ARM = (0.3, -1.2, 1.1, 0.4, 0.9, 0.5)


def _with(**joints: float) -> Array:
    values = np.array(ARM)
    for name, value in joints.items():
        values[int(name[1:]) - 1] = value
    return values


@pytest.mark.parametrize(
    ("name", "joints", "kind"),
    [
        ("ur10", _with(j5=0.0), "wrist"),
        ("ur10", _with(j3=0.0), "elbow"),
        ("ur10 calibrated", _with(j5=0.0), "wrist"),
        ("ur10 calibrated", _with(j3=0.0), "elbow"),
        ("irb4600", _with(j2=0.2, j3=-0.3, j5=0.0), "wrist"),
        ("irb4600", _with(j2=0.2, j3=np.arctan2(0.175, 0.96) - np.pi / 2.0), "elbow"),
    ],
)
def test_a_singular_posture_is_named(name: str, joints: Array, kind: str) -> None:
    """By the geometry of its family."""
    posture = InverseKinematicsSolver(arm(name)).posture(joints)
    assert (posture.singular, posture.kind) == (True, kind)
    assert posture.words.startswith(f"near its {kind} singularity (dexterity 0.0")


@pytest.mark.parametrize(("name", "third"), [("ur10", 1.5), ("irb4600", -0.8)])
def test_a_wrist_above_the_first_axis_is_a_shoulder_singularity(name: str, third: float) -> None:
    """Found by turning joint 2 until the arm is least dexterous."""
    kinematics = arm(name)
    turned = [_with(j2=angle, j3=third) for angle in np.linspace(-1.5, 1.5, 1501)]
    worst = min(turned, key=kinematics.dexterity)
    assert InverseKinematicsSolver(kinematics).posture(worst).kind == "shoulder"


def test_the_hardest_motion_is_the_one_that_the_tool_loses() -> None:
    """A stretched arm cannot move its tool along itself: the joints that do it best need 1/dexterity."""
    kinematics = arm("ur10")
    joints = _with(j3=0.05)
    posture = InverseKinematicsSolver(kinematics).posture(joints)
    _, jacobian = kinematics.tool_pose_and_jacobian(joints)
    needed = np.linalg.lstsq(jacobian, posture.hardest, rcond=None)[0]
    assert np.linalg.norm(needed) == pytest.approx(1.0 / posture.dexterity)
    assert posture.dexterity == pytest.approx(kinematics.dexterity(joints))
    assert posture.manipulability == pytest.approx(abs(np.linalg.det(jacobian)))


def test_a_good_posture_has_nothing_to_say() -> None:
    """Neither kind nor words."""
    posture = InverseKinematicsSolver(arm("ur10")).posture(np.array(ARM))
    assert (posture.singular, posture.kind, posture.words) == (False, "", "")


def test_a_singular_panda_says_what_its_tool_can_hardly_do() -> None:
    """Its family has no names for its singularities."""
    posture = InverseKinematicsSolver(arm("panda")).posture(np.array([0.0, 0.0, np.pi / 2, -1.5, 0.3, 1.0, 0.0]))
    assert (posture.singular, posture.kind) == (True, "")
    assert posture.words.startswith("near a singularity (dexterity 0.003)")
    assert "the tool can hardly move along (" in posture.words


def test_a_solution_comes_with_its_posture() -> None:
    """For those who ask for both."""
    kinematics = arm("irb4600")
    joints = _with(j2=0.2, j3=-0.3, j5=0.0)
    solution = InverseKinematicsSolver(kinematics).solve(kinematics.tool_pose(joints), seed=joints)
    assert solution.posture.kind == "wrist"

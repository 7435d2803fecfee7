"""The ideal arm next to a real one, and the closed form that it opens."""

from __future__ import annotations

import numpy as np
import pytest

from robots.model.inverse_kinematics.analytic import new_analytic_solver
from robots.model.inverse_kinematics.chain import chain_of
from robots.model.inverse_kinematics.ideal_arm import ideal_arm
from tests.robots.model.inverse_kinematics.ik_arms import arm


@pytest.mark.parametrize(
    ("name", "family", "exact"),
    [
        ("ur10", "6R-THREE_INNER_PARALLEL", True),
        ("ur10 of the lab", "6R-THREE_INNER_PARALLEL", True),
        ("ur10 calibrated", "6R-THREE_INNER_PARALLEL", False),
        ("irb4600", "6R-SPHERICAL_SECOND_TWO_PARALLEL", True),
    ],
)
def test_the_family_of_an_arm_is_recognised(name: str, family: str, exact: bool) -> None:
    """Also behind rounded numbers and a calibration."""
    closed = new_analytic_solver(chain_of(arm(name)))
    assert closed is not None
    assert (closed.family, closed.exact, closed.locked) == (family, exact, -1)


def test_a_panda_is_solved_with_its_last_joint_locked() -> None:
    """The other six have a spherical shoulder."""
    closed = new_analytic_solver(chain_of(arm("panda")))
    assert closed is not None
    assert closed.locked == 6


def test_an_arm_of_two_joints_has_no_closed_form() -> None:
    """It is solved by descents."""
    assert new_analytic_solver(chain_of(arm("servo_arm"))) is None


def test_the_axes_of_a_calibrated_arm_are_moved_little_and_made_parallel() -> None:
    """By no more than the calibration has moved them."""
    chain = chain_of(arm("ur10 calibrated"))
    ideal = ideal_arm(chain)
    assert 1e-5 < ideal.moved < 5e-3
    assert np.linalg.norm(np.cross(chain.axes[1], chain.axes[2])) > 1e-5
    assert np.linalg.norm(np.cross(ideal.axes[1], ideal.axes[2])) < 1e-15
    assert ideal_arm(chain_of(arm("irb4600"))).moved < 1e-12

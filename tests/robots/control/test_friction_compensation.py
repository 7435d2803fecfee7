"""Compensation of nominal friction: along a velocity in motion, and an integral within its bounds at rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.control.friction_compensation import SET_POINT_SMOOTH_RAD_S, SMOOTH_RAD_S, FrictionCompensation
from robots.model.robot_model import JointFriction

STEP_S = 0.001
COULOMB_NM, VISCOUS_NMS_RAD = np.array([0.8, 0.1]), np.array([0.4, 0.05])
STILL = np.zeros(2)


def new_compensation() -> FrictionCompensation:
    """The compensation of two joints."""
    friction = JointFriction(coulomb_nm=(0.8, 0.1), viscous_nms_rad=(0.4, 0.05))
    return FrictionCompensation(friction)


def rested(spring_nm: tuple[float, float], seconds: float) -> FrictionCompensation:
    """A compensation whose springs have carried these torques at rest."""
    compensation = new_compensation()
    for _ in range(round(seconds / STEP_S)):
        compensation.integrate(np.array(spring_nm), velocity=STILL, step_s=STEP_S)
    return compensation


@settings(deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_it_pushes_along_the_velocity_and_never_more_than_the_friction(first: float, second: float) -> None:
    velocity = np.array([first, second])
    torque = new_compensation().along(velocity)
    assert (torque * velocity >= 0.0).all()
    assert (np.abs(torque) <= COULOMB_NM + VISCOUS_NMS_RAD * np.abs(velocity)).all()
    assert new_compensation().along(-velocity) == pytest.approx(-torque)


def test_it_is_the_whole_friction_of_a_fast_joint_and_smooth_through_zero() -> None:
    compensation = new_compensation()
    assert compensation.along(np.array([1.0, -1.0])) == pytest.approx([1.2, -0.15])
    assert compensation.along(STILL).tolist() == [0.0, 0.0]
    little = 1e-4 * SMOOTH_RAD_S
    slope = compensation.along(np.full(2, little)) / little
    assert slope == pytest.approx(COULOMB_NM / SMOOTH_RAD_S + VISCOUS_NMS_RAD, rel=1e-6)


def test_a_set_point_loses_it_only_just_before_it_stands() -> None:
    """A joint whose friction is compensated no more sticks: what is left of its way it does not make."""
    compensation = new_compensation()
    slow = np.full(2, 0.5 * SMOOTH_RAD_S)
    assert compensation.ahead(slow) == pytest.approx(COULOMB_NM + VISCOUS_NMS_RAD * slow, rel=1e-3)
    assert (compensation.along(slow) < 0.6 * COULOMB_NM).all()
    assert compensation.ahead(STILL).tolist() == [0.0, 0.0]
    slowest = np.full(2, SET_POINT_SMOOTH_RAD_S)
    assert (compensation.ahead(-slowest) < -0.76 * COULOMB_NM).all()


def test_a_hand_is_helped_by_half_the_friction_and_by_no_more_than_it_pushes() -> None:
    compensation, moving = new_compensation(), np.array([1.0, -1.0])
    assert compensation.helping(moving, pushed_nm=np.array([5.0, -5.0])) == pytest.approx([0.6, -0.075])
    assert compensation.helping(moving, pushed_nm=np.array([0.2, -0.01])) == pytest.approx([0.2, -0.01])
    assert compensation.helping(moving, pushed_nm=np.array([-5.0, 5.0])).tolist() == [0.0, 0.0]
    assert compensation.helping(moving, pushed_nm=STILL).tolist() == [0.0, 0.0]
    assert compensation.helping(STILL, pushed_nm=np.array([5.0, 5.0])).tolist() == [0.0, 0.0]


def test_at_rest_it_takes_over_what_the_springs_carry() -> None:
    """A quarter of 0.5 N m in the first 125 ms at 2 a second."""
    assert rested((0.5, -0.05), 0.125).integral_nm == pytest.approx([0.125, -0.0125], rel=1e-9)


def test_it_takes_over_no_more_than_the_friction_however_long_a_contact_lasts() -> None:
    """And lets go at once when the springs pull the other way: nothing is wound up."""
    compensation = rested((40.0, -40.0), 5.0)
    assert compensation.integral_nm == pytest.approx([0.8, -0.1])
    after = compensation.integrate(np.array([-10.0, 10.0]), velocity=STILL, step_s=STEP_S)
    assert after == pytest.approx([0.78, -0.08])


def test_springs_within_the_dead_band_are_left_to_carry() -> None:
    """An integral that goes on until a sticking joint breaks loose would hunt around its goal."""
    assert rested((0.23, -0.029), 5.0).integral_nm.tolist() == [0.0, 0.0]


def test_it_settles_until_the_springs_are_left_to_carry_or_it_has_taken_over_all_it_may() -> None:
    assert not new_compensation().is_settling
    assert rested((0.5, 0.0), 0.1).is_settling
    assert not rested((0.23, -0.029), 0.1).is_settling
    assert not rested((40.0, 0.0), 0.1).is_settling
    assert not rested((-40.0, 0.0), 0.1).is_settling
    assert rested((40.0, -0.05), 0.1).is_settling
    turned = rested((40.0, 0.0), 0.1)
    turned.integrate(np.array([-40.0, 0.0]), velocity=STILL, step_s=STEP_S)
    assert turned.is_settling
    turned.forget()
    assert not turned.is_settling


def test_at_the_end_of_a_motion_it_settles_from_the_first_period_on() -> None:
    compensation = new_compensation()
    compensation.integrate(np.array([0.5, 0.0]), velocity=np.array([0.1, 0.0]), step_s=STEP_S)
    assert compensation.is_settling


def test_it_fades_while_the_set_point_moves_and_the_other_joints_with_it() -> None:
    compensation = rested((0.8, 0.1), 2.0)
    for _ in range(150):
        compensation.integrate(np.array([5.0, 5.0]), velocity=np.array([0.1, 0.0]), step_s=STEP_S)
    assert compensation.integral_nm == pytest.approx(COULOMB_NM * 0.98**150)
    compensation.forget()
    assert compensation.integral_nm.tolist() == [0.0, 0.0]

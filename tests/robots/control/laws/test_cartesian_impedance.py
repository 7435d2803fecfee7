"""The Cartesian law on an arm short enough to check by hand: springs at the tool, whatever the joints are."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from engine.skills.arm_control import ControlSettings
from robots.control.laws.cartesian_impedance import CartesianImpedance
from robots.port import Array
from tests.robots.control.limit_watch import limits
from tests.robots.control.plane_arm import PlaneKinematics, plane_state
from tests.robots.control.set_point import StillPoint

BENT = np.array([0.3, 1.2])
MASS = np.array([[1.2, 0.3], [0.3, 0.4]])
STIFF = ControlSettings(cartesian_stiffness=(1000.0, 500.0, 300.0, 20.0, 20.0, 20.0), nullspace_stiffness_nm_rad=0.0)


def new_law(arm: ControlSettings = STIFF, *, base_rotation: Array | None = None) -> CartesianImpedance:
    """A law for the plane arm."""
    rotation = np.eye(3) if base_rotation is None else base_rotation
    law = CartesianImpedance(limits(), mass_matrix=lambda _: MASS, base_rotation=rotation)
    law.initialize(settings=arm, inertia_kg_m2=np.diag(MASS))
    return law


def expected(error: Array, stiffness: Array) -> Array:
    """Return J^T K e."""
    _, jacobian = PlaneKinematics().tool_pose_and_jacobian(BENT)
    return jacobian.T @ (stiffness * error)


def tool_error(desired: Array) -> Array:
    """Return the error of the plane tool, (6,)."""
    kinematics = PlaneKinematics()
    there, here = kinematics.tool_pose(desired), kinematics.tool_pose(BENT)
    return np.array([*(there.xyz - here.xyz), 0.0, 0.0, float((desired - BENT).sum())])


@settings(max_examples=40, deadline=None)
@given(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05))
def test_the_tool_is_drawn_to_its_set_point_by_the_springs(first: float, second: float) -> None:
    desired = BENT + np.array([first, second])
    torque = new_law().step(plane_state(BENT), StillPoint(desired), feedforward_nm=np.zeros(2))
    assert torque == pytest.approx(expected(tool_error(desired), np.array(STIFF.cartesian_stiffness)), abs=1e-9)


def test_the_springs_are_along_the_axes_of_the_base() -> None:
    """The base is turned by 90 degrees about z: what was stiff along x is so along the world's y."""
    turned = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    desired = BENT + np.array([0.02, -0.03])
    torque = new_law(base_rotation=turned).step(plane_state(BENT), StillPoint(desired), feedforward_nm=np.zeros(2))
    world = np.array([500.0, 1000.0, 300.0, 20.0, 20.0, 20.0])
    assert torque == pytest.approx(expected(tool_error(desired), world), abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
def test_damping_takes_energy_out_in_every_configuration(
    first: float, second: float, first_rate: float, second_rate: float
) -> None:
    """Singular ones included, where the torques stay bounded; at speeds at which none is clipped."""
    velocity = np.array([first_rate, second_rate])
    joints = np.array([first, second])
    state = plane_state(joints, velocity)
    torque = new_law().step(state, StillPoint(joints), feedforward_nm=np.zeros(2))
    assert np.abs(torque).max() < 60.0
    assert float(torque @ velocity) <= 1e-12


def test_the_damping_ratio_scales_the_damping() -> None:
    """Nothing else is at work at the set point."""
    moving, still = plane_state(BENT, np.array([0.02, -0.01])), StillPoint(BENT)
    critical = new_law().step(moving, still, feedforward_nm=np.zeros(2))
    half = new_law(replace(STIFF, cartesian_damping_ratio=0.5)).step(moving, still, feedforward_nm=np.zeros(2))
    assert np.abs(critical).min() > 0.01
    assert half == pytest.approx(critical / 2.0)


def test_the_feedforward_is_added_and_the_sum_is_limited() -> None:
    torque = new_law().step(plane_state(BENT), StillPoint(BENT), feedforward_nm=np.array([5.0, -200.0]))
    assert torque.tolist() == pytest.approx([5.0, -87.0])


def test_it_leaves_no_torque_behind() -> None:
    assert new_law().terminate().tolist() == [0.0, 0.0]

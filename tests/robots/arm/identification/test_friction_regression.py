"""Torques of a joint with known friction on a swing give it back, whatever the model has wrong."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.arm.identification.friction_regression import estimate_friction, moves

T = np.linspace(0.0, 6.0, 601)
POSITION = 0.4 * np.sin(np.pi * T / 6.0) ** 2 * np.sin(2.0 * np.pi * 2.0 * T / 6.0)
VELOCITY = np.gradient(POSITION, T)
ACCELERATION = np.gradient(VELOCITY, T)


@settings(deadline=None, max_examples=40)
@given(st.floats(0.05, 5.0), st.floats(0.05, 3.0), st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.floats(-0.3, 0.3))
def test_friction_is_separated_from_errors_of_weight_and_inertia(
    coulomb_nm: float, viscous_nms_rad: float, weight_nm: float, slope_nm_rad: float, inertia_kg_m2: float
) -> None:
    excess = coulomb_nm * np.sign(VELOCITY) + viscous_nms_rad * VELOCITY
    excess += weight_nm + slope_nm_rad * POSITION + inertia_kg_m2 * ACCELERATION
    found = estimate_friction(
        "elbow",
        excess_nm=excess,
        position_rad=POSITION + 1.0,
        velocity_rad_s=VELOCITY,
        acceleration_rad_s2=ACCELERATION,
    )
    assert found.joint == "elbow"
    assert found.coulomb_nm == pytest.approx(coulomb_nm, abs=1e-6)
    assert found.viscous_nms_rad == pytest.approx(viscous_nms_rad, abs=1e-6)
    assert found.residual_nm < 1e-6


def test_noise_gives_an_uncertainty_that_holds() -> None:
    inside = 0
    for seed in range(50):
        noise = np.random.default_rng(seed).normal(0.0, 0.1, len(T))
        excess = 0.9 * np.sign(VELOCITY) + 0.4 * VELOCITY + noise
        found = estimate_friction(
            "elbow", excess_nm=excess, position_rad=POSITION, velocity_rad_s=VELOCITY, acceleration_rad_s2=ACCELERATION
        )
        inside += abs(found.coulomb_nm - 0.9) < found.coulomb_uncertainty_nm
        assert found.coulomb_uncertainty_nm < 0.3
    assert inside >= 48


def test_a_joint_that_hardly_moved_is_not_measured() -> None:
    assert moves(VELOCITY)
    assert not moves(0.01 * VELOCITY)

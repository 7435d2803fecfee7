"""Wrenches of a known payload in many orientations give it back; too few orientations are refused."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from robots.arm.identification.payload_regression import WristSamples, estimate_payload
from robots.port import Array

NONE = (0.0, 0.0, 0.0)


def samples(mass_kg: float, com_m: Array, *, tilt_rad: float = 0.5, offset: Array | None = None) -> WristSamples:
    """What a perfect sensor with an offset measures on a swing, in the axes of the tool."""
    u = np.linspace(0.0, 2.0 * np.pi, 400)
    about_x, about_y = tilt_rad * np.sin(u), tilt_rad * np.sin(2.0 * u)
    falling = 9.81 * np.column_stack((np.sin(about_y), np.sin(about_x), np.cos(about_x) * np.cos(about_y)))
    bias = np.zeros(6) if offset is None else offset
    force = mass_kg * falling
    return WristSamples(force_n=force + bias[:3], torque_nm=np.cross(com_m, force) + bias[3:], falling_m_s2=falling)


@settings(deadline=None, max_examples=40)
@given(
    st.floats(0.05, 60.0),
    st.tuples(*[st.floats(-0.3, 0.3)] * 3),
    st.tuples(*[st.floats(-2.0, 2.0)] * 6),
)
def test_a_payload_is_found_whatever_the_offset_of_the_sensor(
    mass_kg: float, com_m: tuple[float, ...], offset: tuple[float, ...]
) -> None:
    found = estimate_payload(samples(mass_kg, np.array(com_m), offset=np.array(offset)), set_kg=0.0, set_com_m=NONE)
    assert found.mass_kg == pytest.approx(mass_kg, rel=1e-6)
    assert found.com_m == pytest.approx(com_m, abs=1e-6)
    assert found.residual_n < 1e-6
    assert found.mass_uncertainty_kg < 1e-6 * mass_kg + 1e-9


def test_the_load_that_is_set_is_part_of_what_is_carried() -> None:
    """2 kg at 0.1 m are set, and 2 kg more hang at 0.3 m: 4 kg at 0.2 m."""
    found = estimate_payload(samples(2.0, np.array([0.0, 0.0, 0.3])), set_kg=2.0, set_com_m=(0.0, 0.0, 0.1))
    assert (found.mass_kg, found.com_m[2]) == (pytest.approx(4.0), pytest.approx(0.2))


def test_noise_gives_an_uncertainty_that_holds() -> None:
    clean = samples(1.0, np.array([0.02, 0.0, 0.05]))
    inside = 0
    for seed in range(50):
        draw = np.random.default_rng(seed)
        noisy = WristSamples(
            force_n=clean.force_n + draw.normal(0.0, 0.5, clean.force_n.shape),
            torque_nm=clean.torque_nm + draw.normal(0.0, 0.05, clean.torque_nm.shape),
            falling_m_s2=clean.falling_m_s2,
        )
        found = estimate_payload(noisy, set_kg=0.0, set_com_m=NONE)
        inside += abs(found.mass_kg - 1.0) < found.mass_uncertainty_kg
        assert found.residual_n == pytest.approx(0.5, rel=0.1)
    assert inside >= 48


def test_a_tool_that_is_not_tilted_is_refused() -> None:
    """Weight and offset of the sensor then point the same way."""
    with pytest.raises(RobotError, match="tilted too little"):
        estimate_payload(samples(1.0, np.zeros(3), tilt_rad=0.01), set_kg=0.0, set_com_m=NONE)

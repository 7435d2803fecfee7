"""The floating law: nothing but the feedforward inside the limits, a spring where the set point stays behind."""

from __future__ import annotations

import numpy as np
import pytest

from engine.skills.arm_control import ControlSettings
from robots.control.laws.gravity_compensation import GravityCompensation
from robots.control.laws.joint_impedance import nominal_stiffness_nm_rad
from robots.port import Array
from tests.robots.control.limit_watch import limits
from tests.robots.control.plane_arm import plane_state
from tests.robots.control.set_point import StillPoint

INERTIA = np.array([1.0, 0.25])
STIFFNESS = nominal_stiffness_nm_rad(limits())
CRITICAL = 2.0 * np.sqrt(STIFFNESS * INERTIA)
WEIGHT = np.array([10.0, -3.0])


def torque(*, position: Array, set_point: Array, velocity: Array, share: float = 0.0) -> list[float]:
    """Return the torque with this share of damping."""
    law = GravityCompensation(limits())
    law.initialize(settings=ControlSettings(), inertia_kg_m2=INERTIA)
    law.damping_share = share
    return law.step(plane_state(position, velocity), StillPoint(set_point), feedforward_nm=WEIGHT).tolist()


def test_an_arm_inside_its_limits_is_only_held_up() -> None:
    here = np.array([0.4, 0.5])
    assert torque(position=here, set_point=here, velocity=np.array([0.3, 0.2])) == WEIGHT.tolist()


def test_the_share_of_damping_is_left() -> None:
    here, velocity = np.array([0.4, 0.5]), np.array([0.3, 0.2])
    expected = (WEIGHT - 0.25 * CRITICAL * velocity).tolist()
    assert torque(position=here, set_point=here, velocity=velocity, share=0.25) == pytest.approx(expected)


def test_where_the_set_point_stays_behind_a_damped_spring_pushes_back() -> None:
    position, behind, velocity = np.array([0.4, 1.99]), np.array([0.4, 1.97]), np.array([0.3, 0.2])
    second = WEIGHT[1] - 0.02 * STIFFNESS[1] - CRITICAL[1] * 0.2
    assert torque(position=position, set_point=behind, velocity=velocity) == pytest.approx([WEIGHT[0], second])


def test_what_is_faster_than_half_the_limit_is_braked() -> None:
    """The limit is 2 rad/s."""
    here = np.array([0.4, 0.5])
    expected = [WEIGHT[0] - CRITICAL[0] * 0.2, WEIGHT[1]]
    assert torque(position=here, set_point=here, velocity=np.array([1.2, 0.9])) == pytest.approx(expected)

"""The impedance law: spring, damper, feedforward, torque limits, nothing after the end."""

from __future__ import annotations

import numpy as np
import pytest

from engine.skills.arm_control import ControlSettings
from robots.control.laws.joint_impedance import JointImpedance, nominal_stiffness_nm_rad
from robots.port import Array
from tests.robots.control.limit_watch import limits
from tests.robots.control.plane_arm import plane_state
from tests.robots.control.set_point import StillPoint

ZERO = np.zeros(2)
INERTIA = np.array([1.0, 0.25])


def new_law(settings: ControlSettings) -> JointImpedance:
    """Joints of 87 N m and these inertias."""
    law = JointImpedance(limits())
    law.initialize(settings=settings, inertia_kg_m2=INERTIA)
    return law


@pytest.fixture(name="law")
def _law() -> JointImpedance:
    return new_law(ControlSettings(joint_stiffness_nm_rad=(100.0, 400.0)))


def torque(
    law: JointImpedance, *, error: Array = ZERO, error_rate: Array = ZERO, feedforward: Array = ZERO
) -> list[float]:
    """Return the torque for a set point that is `error` ahead."""
    return law.step(plane_state(), StillPoint(error, error_rate), feedforward_nm=feedforward).tolist()


def test_an_error_is_answered_by_stiffness(law: JointImpedance) -> None:
    assert torque(law, error=np.array([0.1, 0.01])) == pytest.approx([10.0, 4.0])


def test_a_rate_is_answered_by_critical_damping(law: JointImpedance) -> None:
    assert torque(law, error_rate=np.array([0.1, 0.1])) == pytest.approx([2.0, 2.0])


def test_the_damping_ratio_scales_the_damping() -> None:
    law = new_law(ControlSettings(joint_stiffness_nm_rad=(100.0, 400.0), joint_damping_ratio=0.5))
    assert torque(law, error_rate=np.array([0.1, 0.1])) == pytest.approx([1.0, 1.0])


def test_without_a_stiffness_the_nominal_one_is_used() -> None:
    nominal = nominal_stiffness_nm_rad(limits())
    assert torque(new_law(ControlSettings()), error=np.array([0.01, 0.0])) == pytest.approx([0.01 * nominal[0], 0.0])


def test_the_feedforward_is_added_and_the_sum_is_limited(law: JointImpedance) -> None:
    assert torque(law, error=np.array([0.1, -1.0]), feedforward=np.array([5.0, 5.0])) == pytest.approx([15.0, -87.0])


def test_it_leaves_no_torque_behind(law: JointImpedance) -> None:
    torque(law, error=np.ones(2))
    assert law.terminate().tolist() == [0.0, 0.0]

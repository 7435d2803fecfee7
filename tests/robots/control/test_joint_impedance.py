"""The impedance law: spring, damper, feedforward, torque limits, nothing after the end."""

from __future__ import annotations

import numpy as np
import pytest

from robots.control.joint_impedance import ImpedanceGains, JointImpedance
from robots.port import Array

ZERO = np.zeros(2)


@pytest.fixture(name="law")
def _law() -> JointImpedance:
    gains = ImpedanceGains(stiffness_nm_rad=np.array([100.0, 400.0]), damping_ratio=np.ones(2))
    law = JointImpedance(gains=gains, effort_nm=np.array([87.0, 12.0]))
    law.initialize(inertia_kg_m2=np.array([1.0, 0.25]))
    return law


def torque(
    law: JointImpedance, *, error: Array = ZERO, error_rate: Array = ZERO, feedforward: Array = ZERO
) -> list[float]:
    """Return the torque for a set point that is `error` ahead."""
    return law.step(
        position=ZERO, velocity=ZERO, desired=error, desired_velocity=error_rate, feedforward_nm=feedforward
    ).tolist()


def test_an_error_is_answered_by_stiffness(law: JointImpedance) -> None:
    assert torque(law, error=np.array([0.1, 0.01])) == pytest.approx([10.0, 4.0])


def test_a_rate_is_answered_by_critical_damping(law: JointImpedance) -> None:
    assert torque(law, error_rate=np.array([0.1, 0.1])) == pytest.approx([2.0, 2.0])


def test_the_feedforward_is_added_and_the_sum_is_limited(law: JointImpedance) -> None:
    assert torque(law, error=np.array([0.1, -1.0]), feedforward=np.array([5.0, 5.0])) == pytest.approx([15.0, -12.0])


def test_it_leaves_no_torque_behind(law: JointImpedance) -> None:
    torque(law, error=np.ones(2))
    assert law.terminate().tolist() == [0.0, 0.0]

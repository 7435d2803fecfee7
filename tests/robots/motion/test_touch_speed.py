"""The mass that a tool seems to have, and the speed at which it may touch."""

from __future__ import annotations

import numpy as np
import pytest

from robots.model.mechanics.dynamics import ArmDynamics, Payload
from robots.model.transform import RigidTransform
from robots.motion import plan_line
from robots.motion.touch_speed import effective_mass_kg, friction_push_n, touch_speed_m_s
from robots.port import Array
from tests.robots.panda_arm import panda_kinematics

JOINTS = np.array((0.0, 0.35, 0.0, -2.1, 0.0, 2.45, 0.785))
DOWN = np.array((0.0, 0.0, -1.0))


def accelerated(dynamics: ArmDynamics, push_n: Array) -> Array:
    """Return the acceleration of the tool at rest under a push, m/s², from inverse dynamics."""
    rest = np.zeros(len(JOINTS))
    gravity_nm = dynamics.torque(JOINTS, rest, rest)
    columns = [dynamics.torque(JOINTS, rest, unit) - gravity_nm for unit in np.eye(len(JOINTS))]
    jacobian = panda_kinematics().tool_pose_and_jacobian(JOINTS)[1][:3]
    return jacobian @ np.linalg.solve(np.array(columns).T, jacobian.T @ push_n)


@pytest.mark.parametrize("direction", [DOWN, np.array((1.0, 0.0, 0.0)), np.array((0.6, 0.0, 0.8))])
def test_a_push_accelerates_the_tool_as_it_would_a_body_of_the_effective_mass(direction: Array) -> None:
    dynamics = ArmDynamics(panda_kinematics().model)
    mass_kg = effective_mass_kg(dynamics, panda_kinematics(), JOINTS, direction)
    assert float(accelerated(dynamics, 10.0 * direction) @ direction) * mass_kg == pytest.approx(10.0, rel=1e-6)


def test_a_load_in_the_tool_adds_at_least_its_mass() -> None:
    """More, where the tool moves sideways too under a push."""
    model = panda_kinematics().model
    bare = effective_mass_kg(ArmDynamics(model), panda_kinematics(), JOINTS, DOWN)
    laden = effective_mass_kg(ArmDynamics(model, load=Payload(mass_kg=2.0)), panda_kinematics(), JOINTS, DOWN)
    assert 2.0 < laden - bare < 4.0


def test_a_direction_in_which_no_joint_moves_the_tool_has_a_finite_mass() -> None:
    dynamics = ArmDynamics(panda_kinematics().model)
    assert effective_mass_kg(dynamics, panda_kinematics(), JOINTS, np.zeros(3)) == pytest.approx(1e6)


def test_twice_the_peak_allows_twice_the_speed_and_four_times_the_mass_half_of_it() -> None:
    slow = touch_speed_m_s(5.0, peak_n=10.0, surface_n_m=45000.0)
    assert slow == pytest.approx(10.0 / np.sqrt(5.0 * 45000.0))
    assert touch_speed_m_s(5.0, peak_n=20.0, surface_n_m=45000.0) == pytest.approx(2.0 * slow)
    assert touch_speed_m_s(20.0, peak_n=10.0, surface_n_m=45000.0) == pytest.approx(0.5 * slow)


def test_what_compensates_friction_pushes_with_its_power_over_the_speed_of_the_line() -> None:
    kinematics, speed_m_s = panda_kinematics(), 1e-4
    pose = kinematics.tool_pose(JOINTS)
    lower = RigidTransform(xyz=pose.xyz + speed_m_s * DOWN, xyzw=pose.xyzw)
    line = plan_line(kinematics, JOINTS, lower, duration_s=1.0)
    moved_rad = np.abs(line.position_rad[-1] - JOINTS)
    power = float(np.array(kinematics.model.friction.coulomb_nm) @ moved_rad)
    assert friction_push_n(kinematics, JOINTS, DOWN) == pytest.approx(power / speed_m_s, rel=0.01)
    assert power / speed_m_s > 1.0


def test_of_a_peak_only_what_friction_leaves_is_for_the_speed() -> None:
    whole = touch_speed_m_s(5.0, peak_n=10.0, surface_n_m=45000.0)
    assert touch_speed_m_s(5.0, peak_n=10.0, surface_n_m=45000.0, friction_n=4.0) == pytest.approx(0.6 * whole)

"""Dynamics: pinocchio and MuJoCo agree, energy is kept track of, a load weighs what it weighs."""

from __future__ import annotations

import numpy as np
import pytest

from robots.model.mechanics.dynamics import GRAVITY_M_S2, ArmDynamics, Payload
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import robot_model, robot_names
from robots.model.transform import RigidTransform
from robots.sim.physics.arm_spec import arm_spec
from robots.sim.physics.physics import mujoco

ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@pytest.mark.parametrize("arm", robot_names())
def test_pinocchio_and_mujoco_agree_on_kinematics_and_dynamics(arm: str) -> None:
    """Tool pose, mass matrix with motors, and bias torque at 50 random states; relative to their size."""
    model = robot_model(arm, gripper=None)
    compiled = arm_spec(model).compile()
    data = mujoco.MjData(compiled)
    dynamics, kinematics = ArmDynamics(model), ArmKinematics(model, base=ORIGIN)
    random = np.random.default_rng(0)
    for _ in range(50):
        q = random.uniform(model.limits.lower_rad, model.limits.upper_rad)
        v = random.uniform(-1.0, 1.0, model.dof) * np.array(model.limits.velocity_rad_s)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(compiled, data)
        full = np.zeros((model.dof, model.dof))
        mujoco.mj_fullM(compiled, data, full)
        pose, body = kinematics.tool_pose(q), data.body(model.tool_link)
        assert np.abs(pose.xyz - body.xpos).max() < 1e-12
        assert np.abs(pose.rotation - body.xmat.reshape(3, 3)).max() < 1e-12
        matrix, bias = dynamics.mass_matrix(q), dynamics.bias(q, v)
        # MuJoCo gives links without mass a billionth of a kilogram.
        assert np.abs(matrix - full).max() < 1e-8 * max(1.0, np.abs(matrix).max())
        assert np.abs(bias - data.qfrc_bias).max() < 1e-8 * max(1.0, np.abs(bias).max())


def test_torque_is_mass_times_acceleration_and_bias() -> None:
    model = robot_model("panda")
    dynamics = ArmDynamics(model)
    random = np.random.default_rng(1)
    for _ in range(20):
        q, v, a = (random.uniform(-1.0, 1.0, 7) for _ in range(3))
        assert np.allclose(dynamics.bias(q, 0.0 * v), dynamics.gravity(q), atol=1e-9)
        assert np.allclose(dynamics.torque(q, v, a), dynamics.mass_matrix(q) @ a + dynamics.bias(q, v), atol=1e-9)


def test_motors_add_to_the_diagonal_only() -> None:
    model = robot_model("ur10", gripper=None)
    q = np.array(model.home_rad)
    with_motors, links_only = (ArmDynamics(model, motors=motors).mass_matrix(q) for motors in (True, False))
    assert np.allclose(with_motors - links_only, np.diag(model.armature_kg_m2), atol=1e-12)


def test_a_load_at_the_tool_adds_its_weight_times_the_way_the_tool_sinks() -> None:
    """The joint torques of a weight are Jᵀ times its force, at its centre of mass."""
    model = robot_model("panda")
    kinematics = ArmKinematics(model, base=ORIGIN)
    load = Payload(mass_kg=2.0, com_m=(0.01, -0.02, 0.05), inertia_kg_m2=(0.01, 0.01, 0.01))
    empty, loaded = ArmDynamics(model), ArmDynamics(model, load=load)
    for q in np.random.default_rng(2).uniform(-1.0, 1.0, (10, 7)):
        pose, jacobian = kinematics.tool_pose_and_jacobian(q)
        arm = pose.rotation @ load.com_m
        weight = np.array([0.0, 0.0, -load.mass_kg * GRAVITY_M_S2])
        wrench = np.concatenate((weight, np.cross(arm, weight)))
        assert np.allclose(loaded.gravity(q) - empty.gravity(q), -jacobian.T @ wrench, atol=1e-9)
        assert np.linalg.eigvalsh(loaded.mass_matrix(q) - empty.mass_matrix(q)).min() > -1e-12


def test_an_arm_on_a_wall_feels_gravity_from_the_side() -> None:
    """Base turned about x by a quarter: the first axis lies level and must hold the arm."""
    model = robot_model("ur10", gripper=None)
    wall = RigidTransform.of((0.0, 0.0, 0.0), (np.sin(np.pi / 4), 0.0, 0.0, np.cos(np.pi / 4)))
    q = np.array((0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    assert abs(ArmDynamics(model).gravity(q)[0]) < 1e-6
    assert abs(ArmDynamics(model, base=wall).gravity(q)[0]) > 50.0

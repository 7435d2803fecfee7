"""Inverse kinematics as others do it, and as this project did before: one function from a request to joints or None."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematicsSolver, pose_error, weighted_step
from robots.model.inverse_kinematics.chain import chain_of, matrix_of
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.mechanics.pinocchio_model import arm_model, pin
from robots.model.transform import RigidTransform
from robots.port import Array

Solver = Callable[[RigidTransform, Array], "Array | None"]

_METRES, _RADIANS = 1e-5, 1e-4


def flexcell(kinematics: ArmKinematics) -> Solver:
    """Return this project's solver: the nearest solution."""
    inverse = InverseKinematicsSolver(kinematics)
    inverse.prepare()

    def solve(target: RigidTransform, seed: Array) -> Array | None:
        try:
            return inverse.nearest(target, seed=seed)
        except RobotError:
            return None

    return solve


def eaik(kinematics: ArmKinematics) -> Solver | None:
    """Return EAIK by itself on the arm's own numbers, its first solution within the limits; None if it has none."""
    if find_spec("eaik") is None:
        return None
    native: Any = import_module("eaik.pybindings.EAIK")
    chain = chain_of(kinematics)
    offsets = np.vstack((chain.points[0], np.diff(chain.points, axis=0), chain.tool[:, 3] - chain.points[-1]))
    try:
        robot = native.Robot(chain.axes.T, offsets.T, chain.tool[:, :3], [], True)
    except RuntimeError:
        return None
    if not robot.has_known_decomposition():
        return None
    lower, upper = chain.bounds[:2]
    pose = np.eye(4)

    def solve(target: RigidTransform, seed: Array) -> Array | None:
        pose[:3] = matrix_of(target)
        found = robot.calculate_IK(pose)
        for joints, only_near in zip(found.Q, found.is_LS, strict=True):
            if only_near:
                continue
            turned = joints - 2.0 * np.pi * np.ceil((joints - upper - 1e-9) / (2.0 * np.pi))
            if (turned >= lower - 1e-9).all():
                return np.clip(turned, lower, upper)
        return None

    return solve


def pink(kinematics: ArmKinematics) -> Solver | None:
    """Return pin-pink with the QP solver daqp: 200 steps at most from the seed; None where it is not installed."""
    if find_spec("pink") is None or find_spec("daqp") is None:
        return None
    library: Any = import_module("pink")
    tasks: Any = import_module("pink.tasks")
    model = arm_model(kinematics.model)
    lower, upper = np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)
    model.lowerPositionLimit, model.upperPositionLimit = lower, upper
    limits = [library.limits.ConfigurationLimit(model)]
    to_base = kinematics.base.inverse()

    def solve(target: RigidTransform, seed: Array) -> Array | None:
        configuration = library.Configuration(model, model.createData(), seed)
        task = tasks.FrameTask(kinematics.model.tool_link, position_cost=1.0, orientation_cost=1.0, lm_damping=1e-3)
        in_base = to_base.then(target)
        task.set_target(pin.SE3(in_base.rotation, in_base.xyz))
        for _ in range(200):
            error = task.compute_error(configuration)
            if np.linalg.norm(error[:3]) < _METRES and np.linalg.norm(error[3:]) < _RADIANS:
                return np.array(configuration.q)
            velocity = library.solve_ik(configuration, [task], 1.0, solver="daqp", limits=limits, safety_break=False)
            # Rounding puts joints a hair beyond their limits, of which the library would warn every time.
            moved = np.clip(configuration.integrate(velocity, 1.0), lower, upper)
            configuration.update(moved)
        return None

    return solve


def damped_least_squares(kinematics: ArmKinematics) -> Solver:
    """Return the textbook method in numpy and pinocchio: fixed damping, joints clipped, 200 steps from the seed."""
    lower, upper = np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)

    def solve(target: RigidTransform, seed: Array) -> Array | None:
        joints = seed
        for _ in range(200):
            pose, jacobian = kinematics.tool_pose_and_jacobian(joints)
            error = pose_error(pose, target)
            if np.linalg.norm(error[:3]) < _METRES and np.linalg.norm(error[3:]) < _RADIANS:
                return joints
            joints = np.clip(joints + weighted_step(jacobian, error, damping=1e-2), lower, upper)
        return None

    return solve

"""The solver that this project had before: the same descents with restarts, in Python and pinocchio."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np

from robots.model.inverse_kinematics import ANGLE_TOLERANCE_RAD, POSITION_TOLERANCE_M, pose_error, weighted_step
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array

_ITERATIONS = 60
_RESTARTS = 40
_ALTERNATIVES = 6
_NEAR_RAD = 0.3


@dataclass(frozen=True, kw_only=True)
class _Attempt:
    joints: Array
    distance_m: float
    angle_rad: float

    @property
    def solved(self) -> bool:
        return self.distance_m <= POSITION_TOLERANCE_M and self.angle_rad <= ANGLE_TOLERANCE_RAD


class PythonDescents:
    """Finds joints for a tool pose by descents in Python; deterministic."""

    def __init__(self, kinematics: ArmKinematics) -> None:
        self._kinematics = kinematics
        limits = kinematics.limits
        self._lower, self._upper = np.array(limits.lower_rad), np.array(limits.upper_rad)
        self._speed = np.array(limits.velocity_rad_s)

    def nearest(self, target: RigidTransform, *, seed: Array) -> Array | None:
        """Return the configuration for `target` (world) that is soonest reached from `seed`; None if none was found."""
        first = self._solve(target, np.clip(seed, self._lower, self._upper), near=seed)
        if first.solved and float(np.abs(first.joints - seed).max()) < _NEAR_RAD:
            return first.joints
        solutions = [first.joints] if first.solved else []
        random = np.random.default_rng(_request_seed(target, seed))
        tries = 0
        while tries < (_ALTERNATIVES if solutions else _RESTARTS):
            tries += 1
            attempt = self._solve(target, self._start(random, seed, tries), near=seed)
            if attempt.solved:
                if not solutions:
                    tries = 0
                solutions.append(attempt.joints)
        if not solutions:
            return None
        return min(solutions, key=lambda joints: float(np.max(np.abs(joints - seed) / self._speed)))

    def _start(self, random: np.random.Generator, seed: Array, tries: int) -> Array:
        anywhere = random.uniform(self._lower, self._upper)
        # Every other restart stays on the seed's side of the workspace, where the nearest solutions are.
        share = 1.0 if tries % 2 else 0.35
        return np.clip(seed + share * (anywhere - seed), self._lower, self._upper)

    def _solve(self, target: RigidTransform, start: Array, *, near: Array) -> _Attempt:
        """Levenberg-Marquardt with joints kept at their limits."""
        joints, damping = start, 1e-3
        pose, jacobian = self._kinematics.tool_pose_and_jacobian(joints)
        error = pose_error(pose, target)
        cost = float(error @ error)
        for iteration in range(_ITERATIONS):
            if cost < 1e-14:
                break
            pull = 0.1 * (near - joints) if iteration < _ITERATIONS // 2 else None
            step = self._bounded_step(joints, jacobian, error, damping * cost + 1e-12, pull)
            moved = np.clip(joints + step, self._lower, self._upper)
            pose, new_jacobian = self._kinematics.tool_pose_and_jacobian(moved)
            new_error = pose_error(pose, target)
            new_cost = float(new_error @ new_error)
            if new_cost < cost or (pull is not None and new_cost < 1.5 * cost):
                joints, jacobian, error, cost = moved, new_jacobian, new_error, new_cost
                damping = max(damping * 0.3, 1e-6)
            else:
                damping *= 8.0
                if damping > 1e6:
                    break
        pose = self._kinematics.tool_pose(joints)
        return _Attempt(joints=joints, distance_m=pose.distance_m(target), angle_rad=pose.angle_rad(target))

    def _bounded_step(self, joints: Array, jacobian: Array, error: Array, damping: float, pull: Array | None) -> Array:
        step = weighted_step(jacobian, error, damping=damping, pull=pull)
        for _ in range(3):
            blocked = ((joints <= self._lower) & (step < 0.0)) | ((joints >= self._upper) & (step > 0.0))
            if not blocked.any():
                break
            free = np.where(blocked, 0.0, 1.0)
            step = free * weighted_step(
                jacobian * free, error, damping=damping, pull=None if pull is None else pull * free
            )
        longest = float(np.abs(step).max())
        return step if longest <= 0.6 else step * (0.6 / longest)


def _request_seed(target: RigidTransform, seed: Array) -> int:
    return zlib.crc32(np.concatenate((target.xyz, target.xyzw, seed)).round(9).tobytes())

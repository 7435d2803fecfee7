"""Inverse kinematics of any arm: damped least squares within joint limits, nearest solution, reason why not."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from robots.model.kinematics import ArmKinematics
from robots.model.rigid import Rigid, conjugate, product, rotation_vector
from robots.port import Array

POSITION_TOLERANCE_M = 1e-5
ANGLE_TOLERANCE_RAD = 1e-4

_ITERATIONS = 60
_RESTARTS = 40
# Restarts made after the first solution, in search of a nearer one.
_ALTERNATIVES = 6
# A solution this near is taken without looking for a nearer one.
_NEAR_RAD = 0.3
_AT_LIMIT_RAD = 1e-3


@dataclass(frozen=True, kw_only=True)
class _Attempt:
    joints: Array
    distance_m: float
    angle_rad: float

    @property
    def solved(self) -> bool:
        return self.distance_m <= POSITION_TOLERANCE_M and self.angle_rad <= ANGLE_TOLERANCE_RAD


class InverseKinematics:
    """Finds joints for a tool pose; deterministic: the same request gives the same answer."""

    def __init__(self, kinematics: ArmKinematics) -> None:
        self._kinematics = kinematics
        limits = kinematics.limits
        self._lower, self._upper = np.array(limits.lower_rad), np.array(limits.upper_rad)
        self._speed = np.array(limits.velocity_rad_s)

    def nearest(self, target: Rigid, *, seed: Array) -> Array:
        """Return the configuration for `target` (world) that is soonest reached from `seed`, shape (n,).

        Raises:
            RobotError: none within the joint limits was found.
        """
        first = self._solve(target, np.clip(seed, self._lower, self._upper), near=seed)
        if first.solved and float(np.abs(first.joints - seed).max()) < _NEAR_RAD:
            return first.joints
        solutions = [first.joints] if first.solved else []
        best = first
        random = np.random.default_rng(_request_seed(target, seed))
        tries = 0
        while tries < (_ALTERNATIVES if solutions else _RESTARTS):
            tries += 1
            attempt = self._solve(target, self._start(random, seed, tries), near=seed)
            if attempt.solved:
                if not solutions:
                    tries = 0
                solutions.append(attempt.joints)
            elif attempt.distance_m + 0.1 * attempt.angle_rad < best.distance_m + 0.1 * best.angle_rad:
                best = attempt
        if not solutions:
            raise RobotError(self._reason(target, best))
        return min(solutions, key=lambda joints: float(np.max(np.abs(joints - seed) / self._speed)))

    def track(self, target: Rigid, *, seed: Array) -> Array | None:
        """Return the configuration for `target` next to `seed`, which is almost there; None if there is none."""
        joints = seed.copy()
        for _ in range(8):
            pose, jacobian = self._kinematics.tool_pose_and_jacobian(joints)
            error = pose_error(pose, target)
            if _length(error[:3]) < 1e-7 and _length(error[3:]) < 1e-7:
                return joints
            joints = joints + weighted_step(jacobian, error, damping=1e-9)
        pose = self._kinematics.tool_pose(joints)
        reached = pose.distance_m(target) < POSITION_TOLERANCE_M and pose.angle_rad(target) < ANGLE_TOLERANCE_RAD
        return joints if reached else None

    def _start(self, random: np.random.Generator, seed: Array, tries: int) -> Array:
        anywhere = random.uniform(self._lower, self._upper)
        # Every other restart stays on the seed's side of the workspace, where the nearest solutions are.
        share = 1.0 if tries % 2 else 0.35
        return np.clip(seed + share * (anywhere - seed), self._lower, self._upper)

    def _solve(self, target: Rigid, start: Array, *, near: Array, weight: float = 1.0) -> _Attempt:
        """Levenberg-Marquardt with joints kept at their limits; `weight` 0 leaves the orientation free."""
        joints, damping = start, 1e-3
        weights = np.array([1.0] * 3 + [weight] * 3)
        pose, jacobian = self._kinematics.tool_pose_and_jacobian(joints)
        error = weights * pose_error(pose, target)
        cost = float(error @ error)
        for iteration in range(_ITERATIONS):
            if cost < 1e-14:
                break
            pull = 0.1 * (near - joints) if iteration < _ITERATIONS // 2 else None
            step = self._bounded_step(joints, weights[:, None] * jacobian, error, damping * cost + 1e-12, pull)
            moved = np.clip(joints + step, self._lower, self._upper)
            pose, new_jacobian = self._kinematics.tool_pose_and_jacobian(moved)
            new_error = weights * pose_error(pose, target)
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

    def _reason(self, target: Rigid, best: _Attempt) -> str:
        place = "({:.3f}, {:.3f}, {:.3f})".format(*target.xyz)
        free = self._solve(target, best.joints, near=best.joints, weight=0.0)
        if free.distance_m > 1e-3:
            for start in (np.array(self._kinematics.model.home_rad), (self._lower + self._upper) / 2.0):
                other = self._solve(target, start, near=start, weight=0.0)
                free = other if other.distance_m < free.distance_m else free
        if free.distance_m > 1e-3:
            return f"{place} is out of reach by {free.distance_m:.3f} m{self._at_limits(free.joints)}"
        missing = f"{place} is reached, but not in this orientation: {best.angle_rad:.2f} rad and"
        return f"{missing} {best.distance_m * 1e3:.1f} mm are missing{self._at_limits(best.joints)}"

    def _at_limits(self, joints: Array) -> str:
        names = self._kinematics.model.arm_joints
        words = [
            f"{name} at its {'lower' if low else 'upper'} limit {lower if low else upper:.3f}"
            for name, low, high, lower, upper in zip(
                names,
                joints - self._lower < _AT_LIMIT_RAD,
                self._upper - joints < _AT_LIMIT_RAD,
                self._lower,
                self._upper,
                strict=True,
            )
            if low or high
        ]
        return f" with {' and '.join(words)}" if words else ""


def pose_error(actual: Rigid, target: Rigid) -> Array:
    """Return what is missing: metres, then the rotation vector in world axes, shape (6,)."""
    turn = rotation_vector(product(target.xyzw, conjugate(actual.xyzw)))
    return np.concatenate((target.xyz - actual.xyz, turn))


def weighted_step(jacobian: Array, error: Array, *, damping: float, pull: Array | None = None) -> Array:
    """Return the joint step that removes `error`, damped; `pull` acts where it does not disturb the tool."""
    square = jacobian @ jacobian.T
    square[np.diag_indices_from(square)] += damping + 1e-12
    if pull is None:
        return jacobian.T @ np.linalg.solve(square, error)
    return pull + jacobian.T @ np.linalg.solve(square, error - jacobian @ pull)


def _length(vector: Array) -> float:
    return float(np.sqrt(vector @ vector))


def _request_seed(target: Rigid, seed: Array) -> int:
    return zlib.crc32(np.concatenate((target.xyz, target.xyzw, seed)).round(9).tobytes())

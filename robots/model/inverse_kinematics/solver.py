"""Inverse kinematics of any arm within its joint limits: nearest solution, all solutions, tracking, failure reason."""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from robots.model.inverse_kinematics.chain import jacobian_of, matrix_of
from robots.model.inverse_kinematics.configuration_quality import (
    ConfigurationQuality,
    evaluate_configuration,
    kind_of_singularity,
)
from robots.model.inverse_kinematics.failure_reason import DescentAttempt, unreachable_error
from robots.model.inverse_kinematics.fast_kinematics import FastKinematics, is_solved, new_fast_kinematics
from robots.model.inverse_kinematics.pose_match import PoseMatch
from robots.model.inverse_kinematics.solutions import SolutionSet, distinct, soonest_first, with_turns
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array

# A solution this near to the seed is accepted without a search for a nearer one.
_NEAR_RAD = 0.3
# Descents from other starts until a first solution, and after it for a nearer one; without a
# solution, patient descents from the remaining starts.
_RESTARTS, _ALTERNATIVES, _PATIENT = 40, 6, 100
_STARTS = _RESTARTS + _ALTERNATIVES + _PATIENT
# Number of starts in a sample of all solutions, and of values of a locked joint.
_SAMPLES, _LOCKED_VALUES = 200, 64
# A position this close to the surface reachable by the tool of an arm with fewer joints counts as on it.
_POSITION_CONDITIONS, _OFF_ITS_SURFACE_M = 3, 1e-3
# Below this pivot (a singular value of 0.03, squared) an arm has solutions that the closed form misses.
_IRREGULAR = 1e-3


@dataclass(frozen=True, kw_only=True)
class JointSolution:
    """The joints (n,) for a goal, within the limits, and the quality of the configuration."""

    joints: Array
    posture: ConfigurationQuality


class InverseKinematicsSolver:
    """Computes joints for a tool pose; deterministic: equal requests give equal results.

    Six-axis arms are solved in closed form where their geometry allows it (or almost allows it, refined on
    the true arm), all others by Levenberg-Marquardt descents from the seed and from other starts. Once
    prepared, several threads may use it concurrently.
    """

    def __init__(self, kinematics: ArmKinematics) -> None:
        self._kinematics = kinematics

    def prepare(self) -> None:
        """Load the compiled loops and the arm's closed form, so that the first request does not wait."""
        self._arm().lines(np.array(self._kinematics.model.home_rad))

    def nearest(self, target: RigidTransform, *, seed: Array, match: PoseMatch = PoseMatch.POSE) -> Array:
        """Return the configuration for `target` (world) soonest reached from `seed`, shape (n,).

        The measure is the time of the slowest joint at its speed limit. Exact if the closed form lists all solutions;
        for other arms the best result of a bounded search.

        Raises:
            RobotError: no solution within the joint limits; states the remaining error and the limiting joint.
        """
        arm, goal, seed = self._arm(), matrix_of(target), self._checked(seed)
        if match is PoseMatch.POSE and arm.analytic is not None and arm.analytic.locked < 0:
            found = self._nearest_listed(arm, goal, seed)
            if found is not None:
                return found
        first = arm.descend(goal, match, seed, near=seed)
        if is_solved(first) and float(np.abs(first.joints - seed).max()) < _NEAR_RAD:
            return first.joints
        best = self._searched(arm, target, goal, match, seed, first)
        if is_solved(best):
            return best.joints
        listed = self._listed(arm, goal, match, seed)
        if len(listed.joints):
            return soonest_first(arm.chain, listed.joints, seed)[0]
        if match is PoseMatch.POSITION and arm.chain.dof < _POSITION_CONDITIONS:
            nearest = arm.descend_patiently(goal, match, best.joints)
            if nearest.distance_m <= _OFF_ITS_SURFACE_M:
                return nearest.joints
        raise self._unreachable(arm, target, match, best)

    def solve(self, target: RigidTransform, *, seed: Array, match: PoseMatch = PoseMatch.POSE) -> JointSolution:
        """Return the nearest solution and its quality; raises as `nearest` does."""
        joints = self.nearest(target, seed=seed, match=match)
        return JointSolution(joints=joints, posture=self.posture(joints))

    def all_solutions(
        self, target: RigidTransform, *, seed: Array | None = None, match: PoseMatch = PoseMatch.POSE
    ) -> SolutionSet:
        """Return the solutions for `target` (world), soonest reached from `seed` (the home configuration) first.

        Every turn of a joint within its limits is a separate solution.

        Raises:
            RobotError: no solution within the joint limits.
        """
        arm, goal = self._arm(), matrix_of(target)
        seed = self._checked(np.array(self._kinematics.model.home_rad) if seed is None else seed)
        found = self._listed(arm, goal, match, seed)
        joints = with_turns(arm.chain, found.joints)
        if not len(joints):
            # The search is more patient than the list, and also gives the reason of a failure.
            joints = self.nearest(target, seed=seed, match=match)[None]
            found = SolutionSet(joints=joints, complete=False, how="one solution by a search")
        return SolutionSet(joints=soonest_first(arm.chain, joints, seed), complete=found.complete, how=found.how)

    def track(self, target: RigidTransform, *, seed: Array, match: PoseMatch = PoseMatch.POSE) -> Array | None:
        """Return the configuration for `target` close to `seed`, which is almost there; None if there is none.

        The caller checks joint limits.
        """
        attempt = self._arm().follow(matrix_of(target), match, self._checked(seed))
        return attempt.joints if is_solved(attempt) else None

    def posture(self, joints: Array) -> ConfigurationQuality:
        """Return the quality of a configuration of shape (n,)."""
        arm = self._arm()
        axes, points, tool = arm.lines(self._checked(joints))
        kind = kind_of_singularity(arm.chain, arm.ideal, axes, points)
        return evaluate_configuration(jacobian_of(arm.chain, axes, points, tool), kind)

    def _nearest_listed(self, arm: FastKinematics, goal: Array, seed: Array) -> Array | None:
        """Return the nearest of the closed form's solutions, None if it lists none."""
        if arm.analytic is None:
            return None
        refined = arm.refine(goal, arm.analytic.candidates(goal), seed=seed)
        if not len(refined.joints):
            return None
        nearest = refined.joints[refined.nearest]
        if refined.pivot < _IRREGULAR:
            near = arm.descend(goal, PoseMatch.POSE, seed, near=seed)
            if is_solved(near):
                return soonest_first(arm.chain, np.vstack((nearest, near.joints)), seed)[0]
        return nearest

    def _searched(
        self,
        arm: FastKinematics,
        target: RigidTransform,
        goal: Array,
        match: PoseMatch,
        seed: Array,
        first: DescentAttempt,
    ) -> DescentAttempt:
        """Return the solution soonest reached from `seed`, or the closest attempt.

        `first` is the descent from the seed.
        """
        lower, upper, speed = arm.chain.bounds
        # All starts at once: drawing them singly would take longer than a descent.
        starts = np.random.default_rng(_request_seed(target, seed)).uniform(lower, upper, size=(_STARTS, len(seed)))
        unused = iter(starts)
        solutions = [first] if is_solved(first) else []
        closest = first
        tries = 0
        while tries < (_ALTERNATIVES if solutions else _RESTARTS):
            tries += 1
            # Every other start is on the seed's side of the workspace, where the nearest solutions are.
            share = 1.0 if tries % 2 else 0.35
            attempt = arm.descend(goal, match, seed + share * (next(unused) - seed), near=seed)
            if is_solved(attempt):
                if not solutions:
                    tries = 0
                solutions.append(attempt)
            else:
                closest = min(closest, attempt, key=_shortfall)
        if solutions:
            return min(solutions, key=lambda found: float(np.max(np.abs(found.joints - seed) / speed)))
        for start in unused:
            attempt = arm.descend_patiently(goal, match, start)
            if is_solved(attempt):
                return attempt
            closest = min(closest, attempt, key=_shortfall)
        return closest

    def _listed(self, arm: FastKinematics, goal: Array, match: PoseMatch, seed: Array) -> SolutionSet:
        """Return the distinct solutions, up to whole turns; there may be none."""
        closed = arm.analytic
        if match is not PoseMatch.POSE or closed is None:
            random = np.random.default_rng(0)
            starts = random.uniform(arm.chain.bounds[0], arm.chain.bounds[1], size=(_SAMPLES, arm.chain.dof))
            ends = [arm.descend_patiently(goal, match, start) for start in starts]
            joints = np.array([end.joints for end in ends if is_solved(end)]).reshape(-1, arm.chain.dof)
            complete, how = False, f"sampled by {_SAMPLES} descents"
        elif closed.locked < 0:
            refined = arm.refine(goal, closed.candidates(goal), seed=seed)
            joints, complete = refined.joints, closed.exact and refined.pivot >= _IRREGULAR
            how = "closed form" if closed.exact else "closed form of the nearest ideal arm, refined"
        else:
            lower, upper = arm.chain.bounds[:2, closed.locked]
            values: list[float] = np.linspace(float(lower), float(upper), _LOCKED_VALUES).tolist()
            candidates = np.vstack([closed.candidates_with(goal, value) for value in values])
            joints, complete = arm.refine(goal, candidates, seed=seed).joints, False
            name = self._kinematics.model.arm_joints[closed.locked]
            how = f"sampled: closed form for {_LOCKED_VALUES} values of {name}"
        return SolutionSet(joints=distinct(arm.chain, joints), complete=complete, how=how)

    def _unreachable(
        self, arm: FastKinematics, target: RigidTransform, match: PoseMatch, best: DescentAttempt
    ) -> RobotError:
        goal, model = matrix_of(target), self._kinematics.model
        return unreachable_error(
            target,
            match,
            # A complete descent, so that the reported error is the true remaining error.
            arm.descend_patiently(goal, match, best.joints),
            chain=arm.chain,
            names=model.arm_joints,
            starts=(np.array(model.home_rad), (arm.chain.bounds[0] + arm.chain.bounds[1]) / 2.0),
            to_position=lambda start: arm.descend_patiently(goal, PoseMatch.POSITION, start),
        )

    def _arm(self) -> FastKinematics:
        return new_fast_kinematics(self._kinematics)

    def _checked(self, joints: Array) -> Array:
        """Return validated `joints` for the compiled loops, which do not check."""
        array = np.ascontiguousarray(joints, dtype=np.float64)
        if array.shape != (self._kinematics.dof,) or not np.isfinite(array).all():
            raise RobotError(
                f"{array.tolist()} is not a configuration of {self._kinematics.model.name}",
                hint=f"give {self._kinematics.dof} finite numbers, radians",
            )
        return array


def _request_seed(target: RigidTransform, seed: Array) -> int:
    numbers = np.concatenate((target.xyz, target.xyzw, seed))
    # Rounding multiplies, and a position may be as far as a float can represent.
    return zlib.crc32(numbers.clip(-1e9, 1e9).round(9).tobytes())


def _shortfall(attempt: DescentAttempt) -> float:
    return attempt.distance_m + 0.1 * attempt.angle_rad

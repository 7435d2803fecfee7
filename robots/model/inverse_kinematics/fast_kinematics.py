"""One arm prepared for fast inverse kinematics: chain, closed form, and typed calls of the compiled loops."""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from robots.model.inverse_kinematics.analytic import AnalyticSolver, new_analytic_solver
from robots.model.inverse_kinematics.chain import KinematicChain, chain_of
from robots.model.inverse_kinematics.failure_reason import DescentAttempt
from robots.model.inverse_kinematics.ideal_arm import IdealArm, ideal_arm
from robots.model.inverse_kinematics.pose_match import PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array

# The compiled loops are imported inside the functions that run them: numba takes a third of a second to import,
# and most programs that import robots never use inverse kinematics.

POSITION_TOLERANCE_M = 1e-5
ANGLE_TOLERANCE_RAD = 1e-4

PULLED, ITERATIONS, PATIENT_ITERATIONS = 30, 60, 150
"""Iterations of a descent with redundant joints pulled to the seed, and in total; of a patient descent."""


@dataclass(frozen=True, kw_only=True)
class RefinedSolutions:
    """Refined solutions: `joints` (k, n), the row soonest reached, and a measure of regularity.

    `pivot` is an upper bound of the square of the smallest singular value encountered.
    """

    joints: Array
    nearest: int
    pivot: float


@dataclass(frozen=True, kw_only=True)
class FastKinematics:
    """The parameters of one arm at its base pose; stateless, so threads may share it."""

    chain: KinematicChain
    ideal: IdealArm
    analytic: AnalyticSolver | None

    def lines(self, joints: Array) -> tuple[Array, Array, Array]:
        """Return the joint axes (n, 3), a point on each (n, 3) and the tool's pose (3, 4), in the world."""
        from robots.model.inverse_kinematics import kernels

        axes, points, tool = np.empty((len(joints), 3)), np.empty((len(joints), 3)), np.empty((3, 4))
        kernels.place(self.chain.placements, self.chain.sliding, joints, axes, points, tool)
        return axes, points, tool

    def descend(self, goal: Array, match: PoseMatch, start: Array, *, near: Array) -> DescentAttempt:
        """Descend from `start` (n,) within the limits; a redundant arm is pulled to `near`."""
        from robots.model.inverse_kinematics import kernels

        c = self.chain
        joints = np.minimum(np.maximum(start, c.bounds[0]), c.bounds[1])
        distance, angle = kernels.descend(
            c.placements, c.sliding, c.bounds, goal, match.value, near, PULLED, ITERATIONS, joints
        )
        return DescentAttempt(joints=joints, distance_m=distance, angle_rad=angle)

    def descend_patiently(self, goal: Array, match: PoseMatch, start: Array) -> DescentAttempt:
        """Descend from `start` (n,), which is within the limits, towards the goal only."""
        from robots.model.inverse_kinematics import kernels

        c, joints = self.chain, start.copy()
        distance, angle = kernels.descend(
            c.placements, c.sliding, c.bounds, goal, match.value, joints, 0, PATIENT_ITERATIONS, joints
        )
        return DescentAttempt(joints=joints, distance_m=distance, angle_rad=angle)

    def refine(self, goal: Array, candidates: Array, *, seed: Array) -> RefinedSolutions:
        """Refine approximate solutions (k, n), each joint in the turn within the limits nearest to `seed`."""
        from robots.model.inverse_kinematics import kernels

        c = self.chain
        found = np.empty_like(candidates)
        count, nearest, pivot = kernels.refine(
            c.placements,
            c.sliding,
            c.bounds,
            goal,
            PoseMatch.POSE.value,
            seed,
            candidates,
            POSITION_TOLERANCE_M,
            ANGLE_TOLERANCE_RAD,
            found,
        )
        return RefinedSolutions(joints=found[:count], nearest=nearest, pivot=pivot)

    def follow(self, goal: Array, match: PoseMatch, seed: Array) -> DescentAttempt:
        """Refine joints that are almost at the goal, regardless of limits."""
        from robots.model.inverse_kinematics import kernels

        joints = seed.copy()
        distance, angle = kernels.follow(self.chain.placements, self.chain.sliding, goal, match.value, joints)
        return DescentAttempt(joints=joints, distance_m=distance, angle_rad=angle)


def new_fast_kinematics(kinematics: ArmKinematics) -> FastKinematics:
    """Return the prepared arm, created once per `kinematics` and place of its base.

    Raises:
        CellError: the arm is not a serial chain of single joints.
    """
    base, known = kinematics.base, _PREPARED.get(kinematics)
    if known is not None and known[0] is base:
        return known[1]
    chain = chain_of(kinematics)
    arm = FastKinematics(chain=chain, ideal=ideal_arm(chain), analytic=new_analytic_solver(chain))
    _PREPARED[kinematics] = (base, arm)
    return arm


def is_solved(attempt: DescentAttempt) -> bool:
    """Return whether a descent has reached its goal."""
    return attempt.distance_m <= POSITION_TOLERANCE_M and attempt.angle_rad <= ANGLE_TOLERANCE_RAD


_PREPARED: WeakKeyDictionary[ArmKinematics, tuple[RigidTransform, FastKinematics]] = WeakKeyDictionary()

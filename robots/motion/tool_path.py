"""Computes joints along a path of tool poses, each configuration close to the previous one, or the reason why not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from robots.model.inverse_kinematics import SINGULAR, InverseKinematicsSolver, weighted_step
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.joint_checks import check_range
from robots.port import Array

# Maximum distance of knots in time, position and angle; a spline through them keeps the path.
KNOT_S, KNOT_M, KNOT_RAD = 0.02, 0.006, 0.03
FEWEST_KNOTS, MOST_KNOTS = 12, 4000
SINGULARITY_CAUTION = 0.6
"""Gain with which the self-motion of a redundant arm avoids joint limits, per metre or radian of path."""

_COMFORTABLE_SHARE = 0.75
_WHOLE_POSE = 6


@dataclass(frozen=True, kw_only=True)
class ToolPath:
    """Tool poses in the world, evenly over `duration_s`; the first is the present tool pose.

    `steps` (poses - 1, 6) are the differences to the next pose: metres, then the rotation vector, in world
    axes; `drifts` (poses - 1,) are their lengths, metres and radians together, times `SINGULARITY_CAUTION`.
    `shares` is the completed share of the path at each pose, 0 to 1; `word` names the path in messages,
    such as `line`.
    """

    poses: Sequence[RigidTransform]
    steps: Array
    drifts: Array
    shares: Array
    duration_s: float
    word: str


def follow_tool_path(kinematics: ArmKinematics, start: Array, path: ToolPath) -> Array:
    """Return the joints at each pose of the path, (poses, n); the first are `start`, radians.

    Raises:
        RobotError: a pose is out of reach, a joint would leave its range, or the arm would pass a singularity.
    """
    inverse = InverseKinematicsSolver(kinematics)
    knots = np.empty((len(path.poses), len(start)))
    knots[0] = start
    for i in range(1, len(path.poses)):
        time_s = path.duration_s * i / (len(path.poses) - 1)
        _, jacobian = kinematics.tool_pose_and_jacobian(knots[i - 1])
        _check_dexterity(jacobian, path.word, time_s)
        # The self-motion is a smooth function of the path, independent of time.
        pull = _comfort(kinematics, knots[i - 1]) * path.drifts[i - 1]
        guess = knots[i - 1] + weighted_step(jacobian, path.steps[i - 1], damping=1e-9, pull=pull)
        found = inverse.track(path.poses[i], seed=guess)
        if found is None:
            if kinematics.dof < _WHOLE_POSE:
                raise _too_few_joints(kinematics.dof, path, i)
            raise _out_of_reach(inverse, path, knots[i - 1], i)
        check_range(kinematics.limits, kinematics.model.arm_joints, start, found, time_s)
        knots[i] = found
    return knots


def _comfort(kinematics: ArmKinematics, joints: Array) -> Array:
    """Return the direction in which each joint should drift from its limits: 0 in the middle of its range."""
    lower, upper = np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)
    share = (2.0 * joints - lower - upper) / (upper - lower)
    excess = np.sign(share) * np.maximum(np.abs(share) - _COMFORTABLE_SHARE, 0.0) / (1.0 - _COMFORTABLE_SHARE)
    return -excess


def _check_dexterity(jacobian: Array, word: str, time_s: float) -> None:
    dexterity = float(np.linalg.svd(jacobian, compute_uv=False)[-1])
    if dexterity < SINGULAR:
        raise RobotError(
            f"the {word} passes a singularity at t={time_s:.2f} s (dexterity {dexterity:.3f}, at least {SINGULAR})",
            hint=f"move in joint space, or choose another {word}",
        )


def _too_few_joints(dof: int, path: ToolPath, at: int) -> RobotError:
    return RobotError(
        f"an arm of {dof} joints cannot keep position and orientation of its tool on this {path.word} beyond"
        f" {path.shares[at - 1]:.0%} of it",
        hint="move in joint space, or to the end by position only (`match`)",
    )


def _out_of_reach(inverse: InverseKinematicsSolver, path: ToolPath, joints: Array, at: int) -> RobotError:
    share = float(path.shares[at])
    try:
        inverse.nearest(path.poses[at], seed=joints)
    except RobotError as error:
        return RobotError(f"the {path.word} leaves the workspace after {share:.0%}: {error}")
    return RobotError(
        f"the {path.word} cannot be followed beyond {share:.0%} without a change of the arm's posture",
        hint="move in joint space",
    )

"""Plans a Cartesian DMP from the tool's present pose, or rejects it with the reason."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from engine.errors import RobotError
from engine.messages.primitives import CartDmp
from robots.model.inverse_kinematics import pose_error
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.cart_line import spline_trajectory
from robots.motion.dmp.boundary_conditions import END_SHARE, ENDS, START_SHARE, fade, fade_in, is_negligible
from robots.motion.dmp.integration import GoalChange, PosePath, integrate_pose
from robots.motion.dmp.plan_joint import advise_slower, unreachable_goal_error
from robots.motion.dmp.quaternions import conjugate, exp, log, product, toward
from robots.motion.dmp.task_frame import poses_in_task_frame, transform_dmp
from robots.motion.joint_checks import check_duration, check_speed
from robots.motion.tool_path import (
    FEWEST_KNOTS,
    KNOT_M,
    KNOT_RAD,
    KNOT_S,
    MOST_KNOTS,
    SINGULARITY_CAUTION,
    ToolPath,
    follow_tool_path,
)
from robots.port import Array, JointTrajectory

START_REACH_M, START_REACH_RAD = 0.03, 0.2
"""Maximum distance of the tool from the start of the primitive."""

_NEAR = 0.01
WORLD = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def plan_cart_dmp(
    kinematics: ArmKinematics,
    dmp: CartDmp,
    start: Array,
    *,
    frame: RigidTransform = WORLD,
    goal: RigidTransform | None = None,
    start_reach_m: float = START_REACH_M,
    start_reach_rad: float = START_REACH_RAD,
) -> JointTrajectory:
    """Return the trajectory of the tool along the primitive, from `start` (radians, (n,)) to its goal or to `goal`.

    `frame` is the pose in the world of the primitive's frame; `goal` is in the world. The
    deviation from the primitive's start fades out; `goal` replaces the goal smoothly.

    Raises:
        RobotError: the tool is too far from the start, the path is out of reach or passes a singularity, or a
            joint would exceed its range, speed or acceleration; the message names joint, time and amount.
    """
    own = transform_dmp(poses_in_task_frame(dmp), frame, frame="world")
    here = kinematics.tool_pose(start)
    _check_start(own, here, start_reach_m, start_reach_rad)
    path = resting_pose(own, here, goal)
    duration_s = float(path.shares[-1]) * own.tau
    check_duration(duration_s, "movement")
    knots = follow_tool_path(kinematics, start, _tool_path(path, duration_s))
    trajectory = spline_trajectory(knots, duration_s=duration_s)
    check_speed(
        kinematics.limits,
        kinematics.model.arm_joints,
        trajectory,
        advice=lambda least_s: advise_slower(own.tau, least_s / duration_s),
    )
    return trajectory


def resting_pose(dmp: CartDmp, start: RigidTransform, goal: RigidTransform | None = None) -> PosePath:
    """Return the path of a primitive without `tasktrans` from `start` at rest to its goal, or to `goal`, at rest.

    Raises:
        RobotError: the primitive does not reach its goal.
    """
    target = np.array(dmp.goal) if goal is None else np.concatenate((goal.xyz, goal.xyzw))
    changes = () if goal is None else (GoalChange(share=0.0, goal=target),)
    for end in ENDS:
        path = integrate_pose(dmp, end=end, changes=changes)
        missing = _missing(path, -1, target)
        if is_negligible(missing, path.rate[-1], path.push[-1], a_z=dmp.a_z, least=_NEAR):
            break
    else:
        raise unreachable_goal_error()
    before = _missing(path, 0, np.concatenate((start.xyz, start.xyzw)))
    first, first_rate = fade(path.shares, START_SHARE, value=before, rate=-path.rate[0])
    last, last_rate = fade_in(path.shares, END_SHARE, value=missing, rate=-path.rate[-1], push=-path.push[-1])
    added = first + last
    return PosePath(
        shares=path.shares,
        xyz=path.xyz + added[:, :3],
        xyzw=product(exp(added[:, 3:]), path.xyzw),
        rate=path.rate + first_rate + last_rate,
        push=path.push,
    )


def _missing(path: PosePath, at: int, pose: Array) -> Array:
    """Return the difference from the path at a sample to a pose: metres and a rotation vector, (6,)."""
    turn = product(toward(pose[3:], path.xyzw[at]), conjugate(path.xyzw[at]))
    return np.concatenate((pose[:3] - path.xyz[at], log(turn / np.linalg.norm(turn))))


def _check_start(dmp: CartDmp, here: RigidTransform, reach_m: float, reach_rad: float) -> None:
    start = RigidTransform.of(dmp.y0[:3], dmp.y0[3:])
    away_m, away_rad = start.distance_m(here), start.angle_rad(here)
    if away_m > reach_m or away_rad > reach_rad:
        place = "({:.3f}, {:.3f}, {:.3f})".format(*start.xyz)
        raise RobotError(
            f"the tool is {away_m:.3f} m and {away_rad:.2f} rad from the start {place} of the movement primitive"
            f" (at most {reach_m:g} m and {reach_rad:g} rad)",
            hint="move the tool to the start y0 first",
        )


def _tool_path(path: PosePath, duration_s: float) -> ToolPath:
    """Return the poses of the path at sufficiently dense knots."""
    speed = np.linalg.norm(path.rate[:, :3], axis=1).max(), np.linalg.norm(path.rate[:, 3:], axis=1).max()
    span = float(path.shares[-1])
    knots = max(duration_s / KNOT_S, speed[0] * span / KNOT_M, speed[1] * span / KNOT_RAD, FEWEST_KNOTS)
    at = np.linspace(0.0, span, min(MOST_KNOTS, math.ceil(knots)) + 1)
    poses = _poses_at(path, at)
    steps = np.array([pose_error(*pair) for pair in pairwise(poses)])
    lengths = np.linalg.norm(steps[:, :3], axis=1) + np.linalg.norm(steps[:, 3:], axis=1)
    done = np.concatenate(([0.0], np.cumsum(lengths)))
    return ToolPath(
        poses=poses,
        steps=steps,
        drifts=SINGULARITY_CAUTION * lengths,
        shares=done / max(float(done[-1]), 1e-12),
        duration_s=duration_s,
        word="movement",
    )


def _poses_at(path: PosePath, shares: Array) -> list[RigidTransform]:
    """Return the poses at shares between samples: cubic position, orientation extrapolated from the sample before."""
    step = float(path.shares[1])
    below = np.minimum((shares / step).astype(int), len(path.shares) - 2)
    u = (shares / step - below)[:, None]
    p0, p1, v0, v1 = path.xyz[below], path.xyz[below + 1], path.rate[below, :3], path.rate[below + 1, :3]
    xyz = (
        (1 - 3 * u**2 + 2 * u**3) * p0
        + (3 * u**2 - 2 * u**3) * p1
        + step * ((u - 2 * u**2 + u**3) * v0 + (u**3 - u**2) * v1)
    )
    turn = log(product(path.xyzw[below + 1], conjugate(path.xyzw[below])))
    xyzw = product(exp(u * turn), path.xyzw[below])
    return [RigidTransform.of(place, quaternion) for place, quaternion in zip(xyz, xyzw, strict=True)]

"""Plans a joint DMP from the arm's present joints, at rest at both ends, or rejects it with the reason."""

from __future__ import annotations

import numpy as np

from engine.errors import RobotError
from engine.messages.primitives import JointDmp
from robots.model.robot_model import JointLimits
from robots.motion.dmp.boundary_conditions import END_SHARE, ENDS, START_SHARE, fade, fade_in, is_negligible
from robots.motion.dmp.integration import GoalChange, JointPath, integrate_joints
from robots.motion.dmp.task_frame import joints_in_task_frame
from robots.motion.joint_checks import check_duration, check_range, check_speed
from robots.port import Array, JointTrajectory

START_REACH_RAD = 0.1
"""Maximum distance of a joint from the start of the primitive."""

_NEAR_RAD = 0.01


def plan_joint_dmp(
    dmp: JointDmp,
    start: Array,
    *,
    limits: JointLimits,
    joint_names: tuple[str, ...],
    goal: Array | None = None,
    start_reach_rad: float = START_REACH_RAD,
) -> JointTrajectory:
    """Return the joint trajectory from `start` (radians, (n,)) to the primitive's goal or to `goal`.

    It takes `tau` if the primitive is at rest at its goal by then, as learned ones are, else longer. The
    deviation from the primitive's start fades out; `goal` replaces the goal smoothly.

    Raises:
        RobotError: wrong number of joints, a start too far away, or a joint that would exceed its
            range, speed or acceleration; the message names joint, time and amount.
    """
    own = joints_in_task_frame(dmp)
    _check_joints(own, start, goal, joint_names, start_reach_rad)
    path = resting_joints(own, start, goal)
    duration_s = float(path.shares[-1]) * own.tau
    check_duration(duration_s, "movement")
    trajectory = JointTrajectory(
        dt_s=duration_s / (len(path.shares) - 1), position_rad=path.position, velocity_rad_s=path.rate / own.tau
    )
    for at in _farthest(path.position, start, limits):
        check_range(limits, joint_names, start, path.position[at], float(path.shares[at]) * own.tau)
    check_speed(
        limits,
        joint_names,
        trajectory,
        advice=lambda least_s: advise_slower(own.tau, least_s / duration_s),
    )
    return trajectory


def resting_joints(dmp: JointDmp, start: Array, goal: Array | None = None) -> JointPath:
    """Return the path of a primitive without `tasktrans` from `start` at rest to its goal, or to `goal`, at rest.

    Raises:
        RobotError: the primitive does not reach its goal.
    """
    changes = () if goal is None else (GoalChange(share=0.0, goal=goal),)
    target = np.array(dmp.goal) if goal is None else goal
    for end in ENDS:
        path = integrate_joints(dmp, end=end, changes=changes)
        missing, rate, push = target - path.position[-1], -path.rate[-1], -path.push[-1]
        if is_negligible(missing, rate, push, a_z=dmp.a_z, least=_NEAR_RAD):
            break
    else:
        raise unreachable_goal_error()
    first, first_rate = fade(path.shares, START_SHARE, value=start - path.position[0], rate=-path.rate[0])
    last, last_rate = fade_in(path.shares, END_SHARE, value=missing, rate=rate, push=push)
    position, rates = path.position + first + last, path.rate + first_rate + last_rate
    position[0], position[-1], rates[0], rates[-1] = start, target, 0.0, 0.0
    return JointPath(shares=path.shares, position=position, rate=rates, push=path.push)


def unreachable_goal_error() -> RobotError:
    """Return the error for a primitive whose forcing term keeps it away from its goal."""
    return RobotError(
        f"the movement primitive is not at rest at its goal after {ENDS[-1]:g} tau",
        hint="its weights are far too great for its gains: learn it again",
    )


def advise_slower(tau_s: float, factor: float) -> str:
    """Return the hint to slow a primitive down."""
    return f"give it a tau of at least {np.ceil(tau_s * factor * 100.0 + 1e-6) / 100.0:.2f} s"


def _check_joints(
    dmp: JointDmp, start: Array, goal: Array | None, names: tuple[str, ...], start_reach_rad: float
) -> None:
    for what, count in (
        ("the movement primitive", len(dmp.goal)),
        ("its goal", len(dmp.goal if goal is None else goal)),
    ):
        if count != len(names):
            raise RobotError(f"{what} has {count} joints", hint=f"this arm has {len(names)}")
    if goal is not None and not np.isfinite(goal).all():
        raise RobotError("the goal has a value that is not finite")
    away = np.abs(start - np.array(dmp.y0))
    worst = int(np.argmax(away))
    if away[worst] > start_reach_rad:
        raise RobotError(
            f"{names[worst]} is at {start[worst]:.3f} rad, {away[worst]:.3f} rad from the start"
            f" {dmp.y0[worst]:.3f} rad of the movement primitive (at most {start_reach_rad:g})",
            hint="move the joints to the start y0 first",
        )


def _farthest(position: Array, start: Array, limits: JointLimits) -> tuple[int, int]:
    """Return the samples nearest to, or farthest beyond, the lower and the upper limit (or `start` if beyond)."""
    below = (np.minimum(np.array(limits.lower_rad), start) - position).max(axis=1)
    above = (position - np.maximum(np.array(limits.upper_rad), start)).max(axis=1)
    return int(np.argmax(below)), int(np.argmax(above))

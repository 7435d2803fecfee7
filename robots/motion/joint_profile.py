"""Point-to-point motion in joint space: all joints in phase, trapezoidal or jerk-limited velocity."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import ruckig

from engine.errors import RobotError
from robots.model.robot_model import JointLimits
from robots.port import Array, JointTrajectory

# ruckig has no type stubs: only this file uses it, and returns numpy arrays.
profiles: Any = ruckig

ACCELERATION_SHARE = 0.5
"""Share of the joints' acceleration used at speed 1; the rest is reserved for holding, stopping and tracking."""

JERK_SHARE = 0.95
"""Share of the joints' jerk used by planned motions; the interpolation between two samples may overshoot it."""

_SAMPLE_S = 0.002
# Maximum number of samples of a slow motion: the shape of the profile does not depend on its duration.
_MOST_SAMPLES = 20_000
# The interpolation between two samples may overshoot the velocity at a corner of the trapezoid.
_VELOCITY_SHARE = 0.995
_NO_MOTION_RAD = 1e-9
# At lower speeds a motion would take days.
_SLOWEST_SHARE = 1e-5
_NO_SHARE = 1e-12
# Measured overshoot of a loaded joint at its limit, with margin.
_LIMIT_TOLERANCE_RAD = 1e-3


def plan_joints(
    start: Array,
    goal: Array,
    *,
    speed: float,
    limits: JointLimits,
    joint_names: tuple[str, ...],
) -> JointTrajectory:
    """Return the trajectory from `start` to `goal` (radians, shape (n,)), at rest at both ends.

    `speed` in (0, 1] is the share of the joint velocity limits; accelerations scale with it, and are
    ramped within the joint jerk limits.

    Raises:
        RobotError: the goal has a wrong number of joints, or a joint more than 1 mrad beyond its limit; the speed is
            not a share.
    """
    goal = within_limits(goal, limits, joint_names)
    if not _SLOWEST_SHARE <= speed <= 1.0:
        raise RobotError(f"the speed cannot be {speed:g}", hint=f"give a share from {_SLOWEST_SHARE:g} to 1")
    farthest = float(np.abs(goal - start).max())
    if farthest < _NO_MOTION_RAD:
        return _resting(start, goal)
    shares = np.abs(goal - start) / farthest
    request = profiles.InputParameter(1)
    request.current_position, request.target_position = [0.0], [farthest]
    request.max_velocity = [_slowest(limits.velocity_rad_s, shares) * speed * _VELOCITY_SHARE]
    request.max_acceleration = [_slowest(limits.acceleration_rad_s2, shares) * speed * ACCELERATION_SHARE]
    request.max_jerk = [_slowest(limits.jerk_rad_s3, shares) * JERK_SHARE]
    profile = profiles.Trajectory(1)
    outcome = profiles.Ruckig(1).calculate(request, profile)
    if outcome not in (profiles.Result.Working, profiles.Result.Finished):
        raise RobotError(f"no velocity profile reaches the goal ({outcome})", hint="check the limits of the model")
    return _sampled(profile, start, goal, farthest)


def _slowest(limits: tuple[float, ...], shares: Array) -> float:
    """Return the limit of the joint with the longest path so that no joint exceeds its own.

    All joints follow one profile, as ruckig's own phase synchronisation fails where the slowest
    joint's profile exceeds the limits of another one.
    """
    moving = shares > _NO_SHARE
    return float(np.min(np.array(limits)[moving] / shares[moving]))


def _resting(start: Array, goal: Array) -> JointTrajectory:
    return JointTrajectory(
        dt_s=_SAMPLE_S, position_rad=np.array([start, goal]), velocity_rad_s=np.zeros((2, len(start)))
    )


def within_limits(goal: Array, limits: JointLimits, joint_names: tuple[str, ...]) -> Array:
    """Return the goal; a joint goal slightly beyond its limit, as measured at the limit, is clipped to it.

    Raises:
        RobotError: wrong number of joints, or a joint beyond its limit or not finite.
    """
    if len(goal) != len(joint_names):
        raise RobotError(f"the goal has {len(goal)} joints", hint=f"this arm has {len(joint_names)}")
    clipped = np.clip(goal, limits.lower_rad, limits.upper_rad)
    for joint, name in enumerate(joint_names):
        angle, lower, upper = float(goal[joint]), limits.lower_rad[joint], limits.upper_rad[joint]
        if not math.isfinite(angle) or abs(angle - clipped[joint]) > _LIMIT_TOLERANCE_RAD:
            raise RobotError(f"{name} cannot go to {angle:.4f} rad", hint=f"its range is {lower} to {upper} rad")
    return clipped


def _sampled(profile: Any, start: Array, goal: Array, farthest: float) -> JointTrajectory:
    duration_s = float(profile.duration)
    intervals = min(_MOST_SAMPLES, max(1, math.ceil(duration_s / _SAMPLE_S)))
    dt_s = duration_s / intervals
    states = [profile.at_time(i * dt_s) for i in range(intervals + 1)]
    share = np.array([state[0] for state in states], dtype=np.float64) / farthest
    rate = np.array([state[1] for state in states], dtype=np.float64) / farthest
    position, velocity = start + share * (goal - start), rate * (goal - start)
    position[-1], velocity[0], velocity[-1] = goal, 0.0, 0.0
    return JointTrajectory(dt_s=dt_s, position_rad=position, velocity_rad_s=velocity)

"""Rejects motions beyond an arm's joint limits before anything moves: range, speed, acceleration, by joint and time."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from engine.errors import RobotError
from robots.model.joint_map import JointMap
from robots.model.robot_model import JointLimits
from robots.port import Array, JointTrajectory

LONGEST_S = 86400.0
"""Maximum duration of a planned motion."""


def check_duration(duration_s: float, word: str) -> None:
    """Raise RobotError if the duration of a motion, named `word`, is not positive or far too long."""
    if not 0.0 < duration_s <= LONGEST_S:
        raise RobotError(
            f"a {word} cannot take {duration_s:g} s", hint=f"give it more than 0 s and at most {LONGEST_S:g} s"
        )


def advise_duration(least_s: float) -> str:
    """Return the hint to allow `least_s`, rounded up to a tenth of a second."""
    return f"allow at least {math.ceil(least_s * 10.0 + 1e-6) / 10.0:.1f} s"


def check_range(limits: JointLimits, names: tuple[str, ...], start: Array, joints: Array, time_s: float) -> None:
    """Raise RobotError if a joint leaves its range; `start` and `joints` are radians, (n,), `joints` at `time_s`.

    An arm that is a little beyond a limit at `start` may move back, but not further out.
    """
    lower = np.minimum(np.array(limits.lower_rad), start) - 1e-9
    upper = np.maximum(np.array(limits.upper_rad), start) + 1e-9
    outside = np.maximum(lower - joints, joints - upper)
    worst = int(np.argmax(outside))
    if outside[worst] > 0.0:
        raise RobotError(
            f"{names[worst]} would leave its range at t={time_s:.2f} s: {joints[worst]:.3f} rad,"
            f" range {limits.lower_rad[worst]} to {limits.upper_rad[worst]} rad",
            hint="start from another configuration, or move in joint space",
        )


def check_device_range(joint_map: JointMap, names: tuple[str, ...], trajectory: JointTrajectory) -> None:
    """Raise RobotError if an angle in the convention of the robot's controller leaves its range.

    A trajectory that starts beyond a range may return into it, but not move further out.
    """
    if not np.isfinite((joint_map.lower_rad, joint_map.upper_rad)).any():
        return
    angles = joint_map.to_device(trajectory.position_rad)
    lower = np.minimum(np.array(joint_map.lower_rad), angles[0]) - 1e-9
    upper = np.maximum(np.array(joint_map.upper_rad), angles[0]) + 1e-9
    outside = np.maximum(lower - angles, angles - upper)
    at, joint = np.unravel_index(int(np.argmax(outside)), outside.shape)
    if outside[at, joint] > 0.0:
        raise RobotError(
            f"the controller's angle of {names[joint]} ({joint_map.words(int(joint), names)}) would leave its range"
            f" at t={at * trajectory.dt_s:.2f} s: {angles[at, joint]:.3f} rad,"
            f" range {joint_map.lower_rad[joint]} to {joint_map.upper_rad[joint]} rad",
            hint="the axes are coupled, see `<arm>/device_joints`; choose another configuration",
        )


def check_speed(
    limits: JointLimits,
    names: tuple[str, ...],
    trajectory: JointTrajectory,
    *,
    advice: Callable[[float], str] = advise_duration,
) -> None:
    """Raise RobotError if a joint would exceed its speed or acceleration limit, also between samples.

    Playback interpolates the samples by a cubic Hermite spline. As the path does not depend on its duration, the
    minimum duration is known exactly; `advice` formats it.
    """
    if not (np.isfinite(trajectory.position_rad).all() and np.isfinite(trajectory.velocity_rad_s).all()):
        raise RobotError("the motion overflows", hint="check the motion for values that are far too large or too small")
    duration_s = trajectory.duration_s
    times = np.linspace(0.0, duration_s, len(trajectory.position_rad))
    speed_limit, push_limit = np.array(limits.velocity_rad_s), np.array(limits.acceleration_rad_s2)
    before, after = _accelerations(trajectory)
    peaks, pushes = _peak_speeds(trajectory, before, after), _greatest(before, after)
    slow, hard = np.abs(peaks) / speed_limit, np.abs(pushes) / push_limit
    least_s = duration_s * max(float(slow.max()), math.sqrt(float(hard.max())))
    if least_s <= duration_s:
        return
    asked = f", to arrive after {duration_s:.3g} s"
    if slow.max() > 1.0:
        at, joint = np.unravel_index(int(np.argmax(slow)), slow.shape)
        what = f"{names[joint]} would need {abs(peaks[at, joint]):.2g} rad/s at t={times[at]:.2f} s"
        raise RobotError(f"{what}, limit {speed_limit[joint]:.3g}{asked}", hint=advice(least_s))
    at, joint = np.unravel_index(int(np.argmax(hard)), hard.shape)
    what = f"{names[joint]} would need {abs(pushes[at, joint]):.2g} rad/s² at t={times[at]:.2f} s"
    raise RobotError(f"{what}, limit {push_limit[joint]:.3g}{asked}", hint=advice(least_s))


def _accelerations(trajectory: JointTrajectory) -> tuple[Array, Array]:
    """Return the acceleration at the start and at the end of each interval, (samples - 1, n); linear between them."""
    h = trajectory.dt_s
    rise = np.diff(trajectory.position_rad, axis=0) / h
    first, last = trajectory.velocity_rad_s[:-1], trajectory.velocity_rad_s[1:]
    return (6.0 * rise - 4.0 * first - 2.0 * last) / h, (2.0 * first + 4.0 * last - 6.0 * rise) / h


def _greatest(before: Array, after: Array) -> Array:
    """Return the greater of the accelerations that end and start at each sample, (samples, n)."""
    ending, beginning = np.vstack((before[:1], after)), np.vstack((before, after[-1:]))
    return np.where(np.abs(ending) > np.abs(beginning), ending, beginning)


def _peak_speeds(trajectory: JointTrajectory, before: Array, after: Array) -> Array:
    """Return the greatest speed in the interval that follows each sample, (samples, n).

    The acceleration is linear between two samples, so the speed peaks at one or where it crosses zero.
    """
    peaks = trajectory.velocity_rad_s.copy()
    crossing = before * after < 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        wait = np.where(crossing, before / (before - after), 0.0) * trajectory.dt_s
    inside = peaks[:-1] + 0.5 * before * wait
    peaks[:-1] = np.where(crossing & (np.abs(inside) > np.abs(peaks[:-1])), inside, peaks[:-1])
    return peaks

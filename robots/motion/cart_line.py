"""A straight line of the tool, minimum jerk and SLERP: planned whole, or refused with the reason."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematics, weighted_step
from robots.model.kinematics import ArmKinematics
from robots.model.rigid import Rigid, conjugate, product, rotation_vector
from robots.motion.min_jerk import PEAK_SPEED, min_jerk
from robots.motion.slerp import slerp
from robots.port import Array, JointTrajectory

SINGULAR = 0.03
"""Smallest dexterity (see `ArmKinematics.dexterity`) that a line may pass."""

# Knots are at most this far apart in time, place and turn; a spline through them keeps the line.
_KNOT_S, _KNOT_M, _KNOT_RAD = 0.02, 0.006, 0.03
_FEWEST, _MOST = 12, 4000
# How much the self-motion of a redundant arm shies away from joint limits, per metre or radian of path.
_SHYNESS = 0.6
_COMFORTABLE_SHARE = 0.75


@dataclass(frozen=True, kw_only=True)
class _Line:
    """The wanted path: `distance_m` straight on and `angle_rad` about one axis."""

    start: Rigid
    end: Rigid

    @property
    def distance_m(self) -> float:
        return self.start.distance_m(self.end)

    @property
    def angle_rad(self) -> float:
        return self.start.angle_rad(self.end)

    def at(self, share: float) -> Rigid:
        """Return the tool pose after `share` of the way."""
        return Rigid(
            xyz=self.start.xyz + share * (self.end.xyz - self.start.xyz),
            xyzw=slerp(self.start.xyzw, self.end.xyzw, share),
        )

    def slope(self) -> Array:
        """Return the tool's velocity for one whole way per second, world axes, shape (6,)."""
        turn_here = rotation_vector(product(conjugate(self.start.xyzw), self.end.xyzw))
        return np.concatenate((self.end.xyz - self.start.xyz, self.start.rotation @ turn_here))


def plan_line(kinematics: ArmKinematics, start: Array, end: Rigid, *, duration_s: float) -> JointTrajectory:
    """Return the joints over time that carry the tool straight from `start` (radians, (n,)) to `end` (world).

    Raises:
        RobotError: the end is out of reach, or on the way a joint would pass its limit, its speed or its
            acceleration, or the arm would pass a singularity. Where more time helps, the message says how much.
    """
    line = _Line(start=kinematics.tool_pose(start), end=end)
    shares = min_jerk(np.linspace(0.0, 1.0, _intervals(line, duration_s) + 1))
    knots = _knots(kinematics, line, start, shares, duration_s)
    times = np.linspace(0.0, duration_s, len(shares))
    spline = CubicSpline(times, knots, bc_type="clamped")
    velocity = np.asarray(spline(times, 1), dtype=np.float64)
    acceleration = np.asarray(spline(times, 2), dtype=np.float64)
    _check_speed(kinematics, times, knots, velocity, acceleration)
    velocity[0], velocity[-1] = 0.0, 0.0
    return JointTrajectory(dt_s=duration_s / (len(shares) - 1), position_rad=knots, velocity_rad_s=velocity)


def _intervals(line: _Line, duration_s: float) -> int:
    wanted = max(
        duration_s / _KNOT_S, PEAK_SPEED * line.distance_m / _KNOT_M, PEAK_SPEED * line.angle_rad / _KNOT_RAD, _FEWEST
    )
    return min(_MOST, math.ceil(wanted))


def _knots(kinematics: ArmKinematics, line: _Line, start: Array, shares: Array, duration_s: float) -> Array:
    """Follow the line from knot to knot, each configuration next to the one before."""
    inverse = InverseKinematics(kinematics)
    slope = line.slope()
    knots = np.empty((len(shares), len(start)))
    knots[0] = start
    length = line.distance_m + line.angle_rad
    for i in range(1, len(shares)):
        time_s = duration_s * i / (len(shares) - 1)
        stride = float(shares[i] - shares[i - 1])
        guess = _predicted(kinematics, knots[i - 1], slope, stride, length, time_s)
        found = inverse.track(line.at(float(shares[i])), seed=guess)
        if found is None:
            raise _out_of_reach(inverse, line, knots[i - 1], float(shares[i]))
        _check_range(kinematics, knots[0], found, time_s)
        knots[i] = found
    return knots


def _predicted(
    kinematics: ArmKinematics, joints: Array, slope: Array, stride: float, length: float, time_s: float
) -> Array:
    """Return a guess one stride on; the self-motion is a smooth function of the path, not of time."""
    _, jacobian = kinematics.tool_pose_and_jacobian(joints)
    _check_dexterity(jacobian, time_s)
    pull = _comfort(kinematics, joints) * (_SHYNESS * length * stride)
    return joints + weighted_step(jacobian, slope * stride, damping=1e-9, pull=pull)


def _comfort(kinematics: ArmKinematics, joints: Array) -> Array:
    """Return which way each joint should drift to stay off its limits: 0 in the comfortable middle of its range."""
    lower, upper = np.array(kinematics.limits.lower_rad), np.array(kinematics.limits.upper_rad)
    share = (2.0 * joints - lower - upper) / (upper - lower)
    excess = np.sign(share) * np.maximum(np.abs(share) - _COMFORTABLE_SHARE, 0.0) / (1.0 - _COMFORTABLE_SHARE)
    return -excess


def _check_dexterity(jacobian: Array, time_s: float) -> None:
    dexterity = float(np.linalg.svd(jacobian, compute_uv=False)[-1])
    if dexterity < SINGULAR:
        raise RobotError(
            f"the line passes a singularity at t={time_s:.2f} s (dexterity {dexterity:.3f}, at least {SINGULAR})",
            hint="go there in joint space, or take another line",
        )


def _check_range(kinematics: ArmKinematics, start: Array, joints: Array, time_s: float) -> None:
    limits = kinematics.limits
    # An arm that stands a little beyond a limit may move back, not further out.
    lower = np.minimum(np.array(limits.lower_rad), start) - 1e-9
    upper = np.maximum(np.array(limits.upper_rad), start) + 1e-9
    outside = np.maximum(lower - joints, joints - upper)
    worst = int(np.argmax(outside))
    if outside[worst] > 0.0:
        raise RobotError(
            f"{kinematics.model.arm_joints[worst]} would have to go to {joints[worst]:.3f} rad at t={time_s:.2f} s,"
            f" its range is {limits.lower_rad[worst]} to {limits.upper_rad[worst]} rad",
            hint="start from another configuration, or go there in joint space",
        )


def _out_of_reach(inverse: InverseKinematics, line: _Line, joints: Array, share: float) -> RobotError:
    try:
        inverse.nearest(line.at(share), seed=joints)
    except RobotError as error:
        return RobotError(f"the line leaves the workspace after {share:.0%} of the way: {error}")
    return RobotError(
        f"the line cannot be followed past {share:.0%} of the way without changing the arm's posture",
        hint="go there in joint space",
    )


def _check_speed(kinematics: ArmKinematics, times: Array, knots: Array, velocity: Array, acceleration: Array) -> None:
    """Refuse what is too fast; as the path does not depend on its duration, the least duration is known exactly."""
    limits, names, duration_s = kinematics.limits, kinematics.model.arm_joints, float(times[-1])
    speed_limit, push_limit = np.array(limits.velocity_rad_s), np.array(limits.acceleration_rad_s2)
    peaks = _peak_speeds(times, velocity, acceleration)
    slow = np.abs(peaks) / speed_limit
    hard = np.abs(acceleration) / push_limit
    least_s = duration_s * max(float(slow.max()), math.sqrt(float(hard.max())))
    if least_s <= duration_s:
        return
    allow = f"allow at least {math.ceil(least_s * 10.0 + 1e-6) / 10.0:.1f} s"
    if slow.max() > 1.0:
        at, joint = np.unravel_index(int(np.argmax(slow)), slow.shape)
        what = f"{names[joint]} would need {abs(peaks[at, joint]):.2g} rad/s at t={times[at]:.2f} s"
        raise RobotError(f"{what}, limit {speed_limit[joint]:.3g}", hint=allow)
    at, joint = np.unravel_index(int(np.argmax(hard)), hard.shape)
    what = f"{names[joint]} would need {abs(acceleration[at, joint]):.2g} rad/s² at t={times[at]:.2f} s"
    raise RobotError(f"{what}, limit {push_limit[joint]:.3g}", hint=allow)


def _peak_speeds(times: Array, velocity: Array, acceleration: Array) -> Array:
    """Return the greatest speed in the interval that follows each knot, shape of `velocity`.

    The acceleration is linear between two knots, so the speed peaks at a knot or where it crosses zero.
    """
    peaks = velocity.copy()
    before, after = acceleration[:-1], acceleration[1:]
    crossing = before * after < 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        wait = np.where(crossing, before / (before - after), 0.0) * (times[1] - times[0])
    inside = velocity[:-1] + 0.5 * before * wait
    faster = crossing & (np.abs(inside) > np.abs(peaks[:-1]))
    peaks[:-1] = np.where(faster, inside, peaks[:-1])
    return peaks

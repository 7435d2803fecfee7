"""Plans a straight tool line with minimum jerk and SLERP completely, or rejects it with the reason."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from engine.errors import RobotError
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform, conjugate, product, rotation_vector
from robots.motion.joint_checks import check_duration, check_speed
from robots.motion.slerp import slerp
from robots.motion.speed_profile import MIN_JERK, SpeedProfile
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

_FARTHEST_M = 100.0


@dataclass(frozen=True, kw_only=True)
class _Line:
    """The requested path: `distance_m` along a line and `angle_rad` about one axis."""

    start: RigidTransform
    end: RigidTransform

    @property
    def distance_m(self) -> float:
        return self.start.distance_m(self.end)

    @property
    def angle_rad(self) -> float:
        return self.start.angle_rad(self.end)

    def at(self, share: float) -> RigidTransform:
        """Return the tool pose after `share` of the path."""
        return RigidTransform(
            xyz=self.start.xyz + share * (self.end.xyz - self.start.xyz),
            xyzw=slerp(self.start.xyzw, self.end.xyzw, share),
        )

    def slope(self) -> Array:
        """Return the tool's velocity for the whole path in one second, world axes, shape (6,)."""
        turn_here = rotation_vector(product(conjugate(self.start.xyzw), self.end.xyzw))
        return np.concatenate((self.end.xyz - self.start.xyz, self.start.rotation @ turn_here))


def plan_line(
    kinematics: ArmKinematics, start: Array, end: RigidTransform, *, duration_s: float, profile: SpeedProfile = MIN_JERK
) -> JointTrajectory:
    """Return the joint trajectory that moves the tool straight from `start` (radians, (n,)) to `end` (world).

    Raises:
        RobotError: the duration is invalid, the end is out of reach, a joint would exceed its position, speed or
            acceleration limit, or the arm would pass a singularity. If more time helps, the message states how
            much.
    """
    check_duration(duration_s, "line")
    line = _Line(start=kinematics.tool_pose(start), end=end)
    if not line.distance_m <= _FARTHEST_M:
        raise RobotError(f"the line would be {line.distance_m:.3g} m long", hint="no arm reaches that far")
    shares = profile.shares(np.linspace(0.0, 1.0, _intervals(line, duration_s, profile.peak) + 1))
    poses = [line.at(float(share)) for share in shares]
    strides = np.diff(shares)
    path = ToolPath(
        poses=poses,
        steps=line.slope() * strides[:, None],
        drifts=SINGULARITY_CAUTION * (line.distance_m + line.angle_rad) * strides,
        shares=shares,
        duration_s=duration_s,
        word="line",
    )
    trajectory = spline_trajectory(follow_tool_path(kinematics, start, path), duration_s=duration_s)
    check_speed(kinematics.limits, kinematics.model.arm_joints, trajectory)
    return trajectory


def spline_trajectory(knots: Array, *, duration_s: float) -> JointTrajectory:
    """Return the trajectory through `knots` (radians, (knots, n)), evenly over `duration_s`, at rest at both ends."""
    dt_s = duration_s / (len(knots) - 1)
    return JointTrajectory(dt_s=dt_s, position_rad=knots, velocity_rad_s=_clamped_slopes(knots, dt_s))


def _clamped_slopes(knots: Array, dt_s: float) -> Array:
    """Return the slopes at its knots of the cubic spline that is flat at both ends.

    They solve s[i-1] + 4 s[i] + s[i+1] = 3 (y[i+1] - y[i-1]) / dt, without scipy, whose import takes more than
    0.1 s of CPU time in the middle of a run.
    """
    slopes = np.zeros_like(knots)
    slopes[1:-1] = 3.0 / dt_s * (knots[2:] - knots[:-2])
    shares = [0.0]
    for i in range(1, len(knots) - 1):
        shares.append(1.0 / (4.0 - shares[-1]))
        slopes[i] = (slopes[i] - slopes[i - 1]) * shares[i]
    for i in range(len(knots) - 3, 0, -1):
        slopes[i] -= shares[i] * slopes[i + 1]
    return slopes


def _intervals(line: _Line, duration_s: float, peak_speed: float) -> int:
    knots = max(
        duration_s / KNOT_S,
        peak_speed * line.distance_m / KNOT_M,
        peak_speed * line.angle_rad / KNOT_RAD,
        FEWEST_KNOTS,
    )
    return min(MOST_KNOTS, math.ceil(knots))

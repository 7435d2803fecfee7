"""Converts a validated path to a trajectory: blends corners where that is free, as fast as the joint limits allow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from engine.errors import RobotError
from robots.model.robot_model import JointLimits
from robots.motion.joint_profile import ACCELERATION_SHARE, JERK_SHARE
from robots.planning.timing.blending import MIDDLE_SHARE, BlendedPath, blend_corners, remove_duplicates
from robots.planning.timing.time_parameterization import JointRateLimits, TimeParameterization, time_optimal
from robots.port import Array, JointTrajectory

_SAMPLE_S = 0.002
# Safety factor of the limits: between two samples an interpolator may exceed them slightly.
_SHARE = 0.995
_DEVIATION_RAD, _LONGEST_CUT_RAD = 0.05, 0.5
_HALVINGS = 4
# Length of the mean of the two directions at a corner; below it the path reverses and the arm stops there.
_TURNING_BACK = 0.2


@dataclass(frozen=True, kw_only=True)
class TimedTrajectory:
    """A trajectory at rest at both ends, and the number of `stops` between them."""

    trajectory: JointTrajectory
    stops: int

    @property
    def duration_s(self) -> float:
        """The duration."""
        return self.trajectory.dt_s * (len(self.trajectory.position_rad) - 1)


def time_path(
    path: Array,
    *,
    limits: JointLimits,
    is_free: Callable[[Array], bool],
    speed: float = 1.0,
) -> TimedTrajectory:
    """Return a trajectory along a path of straight joint lines, (waypoints, n), at rest at both ends.

    Blended corners deviate by at most `_DEVIATION_RAD`, less where `is_free` rejects the blend, a path
    (k, n); where it rejects every blend, the arm stops at the corner. `speed` in (0, 1] is the share of the joint
    speed limits; at speed 1 half of the acceleration limits is used, as by all motions, and the full jerk limits at
    any speed.

    Raises:
        RobotError: `speed` is not in (0, 1], the path is empty, or the joint limits allow no motion.
    """
    if not 0.0 < speed <= 1.0 or len(path) == 0:
        raise RobotError(
            f"no trajectory for {len(path)} waypoints at speed {speed}", hint="give waypoints and a speed in (0, 1]"
        )
    waypoints = remove_duplicates(path)
    if len(waypoints) == 1:
        return TimedTrajectory(trajectory=resting(waypoints[0]), stops=0)
    cuts = _free_cuts(waypoints, is_free)
    sections = tuple(
        blend_corners(waypoints[first : last + 1], cuts[first : last + 1]) for first, last in pairwise(stops_of(cuts))
    )
    allowed = rate_limits(limits, speed)
    laws = tuple(time_optimal(section, allowed) for section in sections)
    return TimedTrajectory(trajectory=concatenate(sections, laws), stops=len(sections) - 1)


def rate_limits(limits: JointLimits, speed: float) -> JointRateLimits:
    """Return the limits of a trajectory at `speed`, the share of the joint speed limits."""
    return JointRateLimits(
        velocity=np.array(limits.velocity_rad_s) * (speed * _SHARE),
        acceleration=np.array(limits.acceleration_rad_s2) * (speed * ACCELERATION_SHARE),
        jerk=np.array(limits.jerk_rad_s3) * JERK_SHARE,
    )


def resting(joints: Array) -> JointTrajectory:
    """Return the trajectory of an arm that is already at its goal."""
    position = np.repeat(joints[None], 2, axis=0)
    return JointTrajectory(dt_s=_SAMPLE_S, position_rad=position, velocity_rad_s=np.zeros_like(position))


def stops_of(cuts: Array) -> list[int]:
    """Return the indices of the waypoints where the arm rests: both ends, and those without a blend."""
    return [0, *(i for i in range(1, len(cuts) - 1) if cuts[i] == 0.0), len(cuts) - 1]


def longest_cut_rad(before: Array, after: Array, lengths: tuple[float, float]) -> float:
    """Return the longest blend of a corner between two directions and lines; 0 where the path turns back."""
    if float(np.linalg.norm(before + after)) < 2.0 * _TURNING_BACK:
        return 0.0
    return min(_LONGEST_CUT_RAD, 0.5 * lengths[0], 0.5 * lengths[1])


def _free_cuts(waypoints: Array, is_free: Callable[[Array], bool]) -> Array:
    """Return for each waypoint the length of its blend: as long as desired and free, 0 for a stop."""
    lengths = np.linalg.norm(np.diff(waypoints, axis=0), axis=1)
    directions = np.diff(waypoints, axis=0) / lengths[:, None]
    cuts = np.zeros(len(waypoints))
    for i in range(1, len(waypoints) - 1):
        before, after = directions[i - 1], directions[i]
        longest = longest_cut_rad(before, after, (float(lengths[i - 1]), float(lengths[i])))
        if longest == 0.0:
            continue
        # The largest deviation from the corner is in the middle: 3/16 of a cut times the change of direction.
        cut = min(longest, _DEVIATION_RAD / max(1e-9, MIDDLE_SHARE * float(np.linalg.norm(after - before))))
        for _ in range(_HALVINGS):
            corner = waypoints[i] + np.outer((-cut, 0.0, cut), np.ones(waypoints.shape[1])) * np.vstack(
                (before, before, after)
            )
            if is_free(blend_corners(corner, np.array([0.0, cut, 0.0])).position):
                cuts[i] = cut
                break
            cut *= 0.5
    return cuts


def concatenate(sections: tuple[BlendedPath, ...], laws: tuple[TimeParameterization, ...]) -> JointTrajectory:
    """Return the concatenated sections with their time laws, at rest between them, on one grid of samples."""
    ends = np.cumsum([0.0, *(law.duration_s for law in laws)])
    samples = max(2, math.ceil(float(ends[-1]) / _SAMPLE_S) + 1)
    at = np.linspace(0.0, float(ends[-1]), samples)
    joints = sections[0].position.shape[1]
    position, velocity = np.empty((samples, joints)), np.empty((samples, joints))
    section_of = np.clip(np.searchsorted(ends, at, side="right") - 1, 0, len(sections) - 1)
    for k, law in enumerate(laws):
        in_section = section_of == k
        position[in_section], velocity[in_section] = law.sampled(at[in_section] - ends[k])
    position[0], position[-1] = sections[0].position[0], sections[-1].position[-1]
    velocity[0], velocity[-1] = 0.0, 0.0
    return JointTrajectory(dt_s=float(ends[-1]) / (samples - 1), position_rad=position, velocity_rad_s=velocity)

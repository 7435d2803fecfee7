"""A trajectory that is slowed on a section of its path, and keeps the path and its limits."""

from __future__ import annotations

import math

import numpy as np

from robots.model.robot_model import JointLimits
from robots.motion.speed_profile import integrate_speeds
from robots.port import Array, JointTrajectory

# The pace changes with minimum jerk within these times, the shortest one that keeps the limits.
_BLENDS_S = (0.2, 0.4, 0.8, 1.6)
# Numeric derivatives of samples exceed what they are of by this share.
_SLACK = 1.02


def slow_section(
    trajectory: JointTrajectory, *, from_s: float, to_s: float, speed: float, limits: JointLimits
) -> JointTrajectory:
    """Return the trajectory with at most `speed`, a share of the joint speed limits, from a time of it to another.

    Before and after it the pace changes, where there is time for that within the limits; else it is slow from the start
    or to the end.
    """
    rows = slice(int(from_s / trajectory.dt_s), math.ceil(to_s / trajectory.dt_s) + 1)
    shares = np.abs(trajectory.velocity_rad_s[rows]) / np.array(limits.velocity_rad_s)
    pace = min(1.0, speed / max(float(shares.max(initial=0.0)), 1e-9))
    if pace >= 1.0:
        return trajectory
    for blend_s in _BLENDS_S:
        slowed = _paced(trajectory, from_s=from_s, to_s=to_s, pace=pace, blend_s=blend_s)
        if _keeps_limits(slowed, trajectory, limits):
            return slowed
    return _paced(trajectory, from_s=0.0, to_s=trajectory.duration_s, pace=pace, blend_s=0.0)


def _paced(trajectory: JointTrajectory, *, from_s: float, to_s: float, pace: float, blend_s: float) -> JointTrajectory:
    """Return the trajectory at `pace` between two of its times, with blends before and after them."""
    whole_s, blend_path_s = trajectory.duration_s, blend_s * (1.0 + pace) / 2.0
    lengths, paces = [0.0], [pace]
    if from_s > blend_path_s:
        lengths, paces = [0.0, from_s - blend_path_s, blend_s], [1.0, 1.0, pace]
    start_s = from_s if from_s > blend_path_s else 0.0
    rest_s = whole_s - to_s - blend_path_s
    lengths.append(((to_s if rest_s > 0.0 else whole_s) - start_s) / pace)
    paces.append(pace)
    if rest_s > 0.0:
        lengths += [blend_s, rest_s]
        paces += [1.0, 1.0]
    times = np.cumsum(lengths)
    samples = math.ceil(float(times[-1]) / trajectory.dt_s - 1e-9) + 1
    at_s = np.minimum(np.arange(samples) * trajectory.dt_s, times[-1])
    path_s, paces_at = integrate_speeds(at_s, times, np.array(paces))
    position, velocity = _sampled(trajectory, np.clip(path_s, 0.0, whole_s))
    return JointTrajectory(dt_s=trajectory.dt_s, position_rad=position, velocity_rad_s=velocity * paces_at[:, None])


def _sampled(trajectory: JointTrajectory, at_s: Array) -> tuple[Array, Array]:
    """Return positions and velocities at times of a trajectory, by cubic interpolation."""
    q, v, dt = trajectory.position_rad, trajectory.velocity_rad_s, trajectory.dt_s
    row = np.clip((at_s / dt).astype(int), 0, len(q) - 2)
    u = (at_s / dt - row)[:, None]
    a, b, va, vb = q[row], q[row + 1], v[row] * dt, v[row + 1] * dt
    position = a + u * va + u**2 * (3.0 * (b - a) - 2.0 * va - vb) + u**3 * (2.0 * (a - b) + va + vb)
    return position, v[row] + u * (v[row + 1] - v[row])


def _keeps_limits(slowed: JointTrajectory, given: JointTrajectory, limits: JointLimits) -> bool:
    """Return whether accelerations and jerks are within the limits, or no greater than they were."""
    allowed = (np.array(limits.acceleration_rad_s2), np.array(limits.jerk_rad_s3))
    after, before = (_derivatives(one) for one in (slowed, given))
    return all(
        bool((peak <= np.maximum(limit, had) * _SLACK).all())
        for peak, had, limit in zip(after, before, allowed, strict=True)
    )


def _derivatives(trajectory: JointTrajectory) -> tuple[Array, Array]:
    """Return the greatest accelerations and jerks of the joints."""
    acceleration = np.diff(trajectory.velocity_rad_s, axis=0) / trajectory.dt_s
    jerk = np.diff(acceleration, axis=0) / trajectory.dt_s
    return np.abs(acceleration).max(axis=0, initial=0.0), np.abs(jerk).max(axis=0, initial=0.0)

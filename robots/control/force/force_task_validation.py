"""Validates a force task before anything moves."""

from __future__ import annotations

import math

import numpy as np

from engine.errors import RobotError
from engine.skills.dmp import Compliance
from robots.control.generators.trajectory_playback import validate_trajectory
from robots.port import Array, ForceTask


def validate_force_task(task: ForceTask, *, start_rad: Array, joints: tuple[str, ...]) -> ForceTask:
    """Return `task` if an arm at the set point `start_rad` can execute it.

    Raises:
        RobotError: as `validate_trajectory`; offset or wrench of wrong shape or not finite, an offset beyond the
            reach, or invalid admittance parameters.
    """
    validate_trajectory(task.trajectory, start_rad=start_rad, joints=joints)
    shape = (len(task.trajectory.position_rad), 6)
    for what, values in (("offset", task.offset), ("wrench", task.wrench)):
        if np.shape(values) != shape or not np.isfinite(values).all():
            raise RobotError(
                f"the {what} has shape {np.shape(values)} or values that are not finite",
                hint=f"give finite numbers of shape {shape}, one row for each sample of the trajectory",
            )
    _check_reach(task)
    _check_law(task.admittance)
    if not (task.record_s > 0.0 and math.isfinite(task.slow_per_n) and task.slow_per_n >= 0.0):
        raise RobotError("record_s must be positive and slow_per_n not negative")
    if abs(float(np.linalg.norm(task.task_xyzw)) - 1.0) > 1e-3:
        raise RobotError(f"task_xyzw {task.task_xyzw} is not a unit quaternion", hint="normalise it")
    return task


def _check_reach(task: ForceTask) -> None:
    farthest = np.abs(task.offset).max(axis=0)
    law = task.admittance
    for axis, (far, reach) in enumerate(zip(farthest, (law.reach_m,) * 3 + (law.turn_rad,) * 3, strict=True)):
        if far > reach:
            raise RobotError(
                f"the offset of {far:.4f} along axis {axis} exceeds the reach of {reach:g}",
                hint="raise the admittance's reach_m or turn_rad, or move the path",
            )


def _check_law(law: Compliance) -> None:
    for axis in range(6):
        mass, damping, stiffness = law.mass[axis], law.damping[axis], law.stiffness[axis]
        if law.active[axis] > 0.0 and not all(map(math.isfinite, (mass, damping, stiffness))):
            raise RobotError(
                f"mass {mass}, damping {damping}, stiffness {stiffness} are not finite on axis {axis}",
                hint="give finite numbers",
            )
    if not all(value > 0.0 for value in (law.reach_m, law.turn_rad, law.speed_m_s, law.touch_m_s, law.turn_rad_s)):
        raise RobotError("reach_m, turn_rad, speed_m_s, touch_m_s and turn_rad_s must be positive")

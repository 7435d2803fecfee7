"""Compares every set point with the limits of the arm and with the set points before it."""

from __future__ import annotations

import logging
from typing import Protocol

import numpy as np

from robots.control.motion_event import SetPointJumped
from robots.model.robot_model import JointLimits
from robots.port import Array

_QUANTITIES = ("", "position", "velocity", "acceleration", "jerk")
_UNITS = ("", "rad", "rad/s", "rad/s²", "rad/s³")
# Rounding of a stop that ends at a limit, and of differences of positions.
_ROUNDING_RAD = 2e-6
_VELOCITY_TOLERANCE, _ACCELERATION_TOLERANCE = 1.001, 1.02
# Between its samples a trajectory may exceed its jerk where both its own and that of its pace change.
_JERK_TOLERANCE = 1.1
# A jump shows in the differences of three periods: it is reported once.
_ONE_JUMP_STEPS = 4

_log = logging.getLogger("flexcell.set_points")


def report_jump(jump: SetPointJumped) -> None:
    """Write a jump to the log `flexcell.set_points`; handlers find it as `jump` of the record."""
    _log.warning("%s", jump.reason, extra={"jump": jump})


class WatchedSetPoint(Protocol):
    """The set point of an arm and what generates it."""

    position: Array
    velocity: Array

    @property
    def number(self) -> int:
        """Number of the active motion, 0 for none."""
        ...

    @property
    def leads(self) -> bool:
        """False while the set point follows the arm."""
        ...

    @property
    def generator_name(self) -> str:
        """What generates the set point."""
        ...


class SetPointWatch:
    """Call `look` once in every control period, after the set point has advanced.

    Velocity, acceleration and jerk are differences of the positions that are sent, not what generators say of them.
    While the set point follows the arm, as in guiding, it is compared with nothing; from then on it continues from
    its last position and velocity.

    Args:
        arm: Name of the arm, for messages.
        joints: Joint names, for messages.
        limits: Limits of the joints.
    """

    def __init__(self, *, arm: str, joints: tuple[str, ...], limits: JointLimits) -> None:
        from robots.control import kernels

        self._compare = kernels.compare_set_point
        self._arm = arm
        self._joints = joints
        self._limits = np.array(
            (
                np.array(limits.lower_rad) - _ROUNDING_RAD,
                np.array(limits.upper_rad) + _ROUNDING_RAD,
                np.array(limits.velocity_rad_s) * _VELOCITY_TOLERANCE,
                np.array(limits.acceleration_rad_s2) * _ACCELERATION_TOLERANCE,
                np.array(limits.jerk_rad_s3) * _JERK_TOLERANCE,
            )
        )
        self._past = np.zeros((3, len(joints)))
        self._before = np.zeros((3, len(joints)))
        self._worst = np.zeros(3)
        self._time_s = self._step_s = 0.0
        self._generator = self._previous = ""
        self._steps_since_change = 0
        self._steps_since_jump = _ONE_JUMP_STEPS
        self.count = 0
        """Jumps until now."""

    def reject(self) -> Array:
        """Return position, velocity and acceleration of the last set point before a jump, (3, n), and continue there.

        Call it after `look` has returned a jump, with a set point that is not sent.
        """
        self._past[:] = self._before
        self._steps_since_jump = _ONE_JUMP_STEPS
        self._time_s -= self._step_s
        return self._before

    def restart(self, position: Array, velocity: Array | None = None) -> None:
        """Continue from `position` without a past: the set point starts anew there."""
        self._past[:] = 0.0
        self._past[0] = position
        if velocity is not None:
            self._past[1] = velocity

    def look(self, step_s: float, set_point: WatchedSetPoint) -> SetPointJumped | None:
        """Compare the set point of this period; return a jump that is not part of the last one."""
        self._step_s = step_s
        self._time_s += step_s
        self._follow_generator(set_point.generator_name)
        if not set_point.leads:
            self.restart(set_point.position, set_point.velocity)
            return None
        self._before[:] = self._past
        quantity = self._compare(step_s, set_point.position, self._past, self._limits, self._worst)
        self._steps_since_jump += 1
        if quantity == 0:
            return None
        is_new = self._steps_since_jump > _ONE_JUMP_STEPS
        self._steps_since_jump = 0
        if not is_new:
            return None
        self.count += 1
        jump = self._jump(quantity, set_point.number)
        report_jump(jump)
        return jump

    def _follow_generator(self, name: str) -> None:
        self._steps_since_change += 1
        if name != self._generator:
            self._previous, self._generator, self._steps_since_change = self._generator, name, 0

    def _jump(self, quantity: int, motion: int) -> SetPointJumped:
        joint, value, limit = self._worst.tolist()
        before = self._previous if self._steps_since_change < _ONE_JUMP_STEPS else self._generator
        where = self._generator if before == self._generator else f"{before} → {self._generator}"
        name, unit = _QUANTITIES[quantity], _UNITS[quantity]
        reason = (
            f"the set point of {self._arm} jumped at {self._time_s:.3f} s ({where}): {name} of"
            f" {self._joints[int(joint)]} {value:.4g} {unit}, limit {limit:.4g}"
        )
        return SetPointJumped(
            motion=motion, arm=self._arm, before=before, generator=self._generator, quantity=name,
            ratio=abs(value) / limit if limit else 0.0, reason=reason,
        )  # fmt: skip

"""How fast the joints and the fastest point of an arm are in a motion at its full pace."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np

from robots.control.generators.guarded_motion import GuardedMotion
from robots.control.generators.motion_generator import MotionGenerator
from robots.model.mechanics.kinematics import ArmKinematics
from robots.port import Array

_SAMPLES = 48
_PER_STEP = 4


@runtime_checkable
class OnPath(Protocol):
    """A generator that follows a path of joints, (samples, n), with these velocities at full pace."""

    @property
    def path(self) -> tuple[Array, Array]:
        """Positions and velocities of the samples."""
        ...


class MotionSpeed:
    """The greatest speeds of a motion at full pace, looked up during its first control periods.

    Motions without a known path may use the velocity limits of all joints at once, anywhere.

    Args:
        generator: The motion.
        kinematics: An instance of its own.
    """

    def __init__(self, generator: MotionGenerator, *, kinematics: ArmKinematics) -> None:
        self.generator = generator
        self._kinematics = kinematics
        limits = np.array(kinematics.limits.velocity_rad_s)
        generator = generator.inner if isinstance(generator, GuardedMotion) else generator
        self._rows: list[tuple[Array, Array]] = []
        self._origins: list[Array] = []
        if isinstance(generator, OnPath):
            points, slopes = generator.path
            rows = np.unique(np.linspace(0, len(points) - 1, _SAMPLES).round().astype(int))
            self._rows = [(points[row], slopes[row]) for row in rows.tolist()]
            self.joints_rad_s: Array = np.abs(slopes).max(axis=0)
        else:
            self._origins = [_greatest(kinematics.link_lengths_m(), limits)]
            self.joints_rad_s = limits

    @property
    def known(self) -> bool:
        """Whether all samples have been looked at."""
        return not self._rows

    def look(self) -> None:
        """Look at the next samples."""
        for position, velocity in self._rows[:_PER_STEP]:
            self._origins.append(self._kinematics.link_speeds(position, velocity))
        del self._rows[:_PER_STEP]

    def fastest_m_s(self, extents_m: tuple[float, ...]) -> float:
        """Return an upper bound of the speed of any point; the links extend as in `MeasuredSeparation`."""
        speeds, extents = np.array(self._origins), np.array(extents_m)
        linear, angular = speeds[:, :, 0], speeds[:, :, 1]
        # The points between two joints are no faster than the faster one, but for what they are beside that line.
        ends = np.maximum(linear, np.hstack((linear[:, 1:], linear[:, -1:])))
        return float((ends + angular * extents).max())


def _greatest(lengths_m: Array, limits_rad_s: Array) -> Array:
    """Return speeds that no link exceeds in any configuration, as `ArmKinematics.link_speeds`.

    The arm is as long as its links in a row, and all joints at their limits turn it the same way.
    """
    angular_rad_s = np.cumsum(limits_rad_s)
    linear_m_s = np.concatenate(([0.0], np.cumsum(lengths_m * angular_rad_s[:-1])))
    return np.column_stack((linear_m_s, angular_rad_s))

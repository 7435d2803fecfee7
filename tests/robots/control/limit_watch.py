"""Limits for small arms, and a watch that looks at every period of a set point."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from robots.model.robot_model import JointLimits
from robots.port import Array

STEP_S = 0.001


def limits(joints: int = 2, *, jerk_rad_s3: float = 2000.0, middle_rad: float = 0.0) -> JointLimits:
    """Return limits of +-2 rad about the middle, 2 rad/s and 15 rad/s²."""
    return JointLimits(
        lower_rad=(middle_rad - 2.0,) * joints,
        upper_rad=(middle_rad + 2.0,) * joints,
        velocity_rad_s=(2.0,) * joints,
        acceleration_rad_s2=(15.0,) * joints,
        jerk_rad_s3=(jerk_rad_s3,) * joints,
        effort_nm=(87.0,) * joints,
    )


class SetPointLike(Protocol):
    """What is watched."""

    position: Array
    velocity: Array
    acceleration: Array


@dataclass
class LimitWatch:
    """Call `look` after every period; it fails at the first one beyond a limit."""

    limits: JointLimits
    set_point: SetPointLike
    jerk: bool = True
    positions: list[Array] = field(default_factory=list[Array])
    velocities: list[Array] = field(default_factory=list[Array])
    accelerations: list[Array] = field(default_factory=list[Array])

    def __post_init__(self) -> None:
        self._remember()

    def look(self) -> None:
        """Compare the set point with the limits and with itself one period ago."""
        now = self.set_point
        before, velocity, acceleration = self.positions[-1], self.velocities[-1], self.accelerations[-1]
        assert (now.position <= np.array(self.limits.upper_rad) + 1e-9).all()
        assert (now.position >= np.array(self.limits.lower_rad) - 1e-9).all()
        assert (np.abs(now.velocity) <= np.array(self.limits.velocity_rad_s) * (1 + 1e-9)).all()
        change = (now.velocity - velocity) / STEP_S
        assert (np.abs(change) <= np.array(self.limits.acceleration_rad_s2) * (1 + 1e-9)).all()
        if self.jerk:
            jerk = (now.acceleration - acceleration) / STEP_S
            assert (np.abs(jerk) <= np.array(self.limits.jerk_rad_s3) * (1 + 1e-6)).all()
        # What is called velocity is how the position changes, and so is the acceleration.
        moved = (now.position - before) / STEP_S - (now.velocity + velocity) / 2.0
        assert (np.abs(moved) <= np.array(self.limits.acceleration_rad_s2) * STEP_S).all()
        assert np.abs(change - now.acceleration).max() <= 1e-6 + 0.02 * np.abs(change).max()
        self._remember()

    def _remember(self) -> None:
        self.positions.append(self.set_point.position.copy())
        self.velocities.append(self.set_point.velocity.copy())
        self.accelerations.append(self.set_point.acceleration.copy())

"""What an arm is told to follow, how closely, and what it may end at."""

from __future__ import annotations

from dataclasses import dataclass

from engine.messages import Vector3
from robots.port.arrays import Array


@dataclass(frozen=True, kw_only=True)
class JointTrajectory:
    """A path over time, sampled every `dt_s`: position and velocity of shape (samples, n).

    It starts at the arm's present set point at rest and ends at rest. A hold, cancel or speed
    override slows the passage along it (time scaling), so the arm never leaves the path.
    """

    dt_s: float
    position_rad: Array
    velocity_rad_s: Array

    @property
    def duration_s(self) -> float:
        """Time from the first sample to the last."""
        return (len(self.position_rad) - 1) * self.dt_s


@dataclass(frozen=True, kw_only=True)
class Tolerance:
    """How far the measured joints may be off: on the way, and at the end after `settle_s` at most."""

    path_rad: float = 0.15
    goal_rad: float = 0.01
    settle_s: float = 1.0


@dataclass(frozen=True, kw_only=True)
class ContactCondition:
    """Where a motion ends early: the environment pushes the tool with `force_n`.

    Attributes:
        force_n: Least force.
        direction: Unit vector in the world; only the force along it counts (against the motion: opposite to
            the way). Zero for any direction.
    """

    force_n: float
    direction: Vector3 = (0.0, 0.0, 0.0)

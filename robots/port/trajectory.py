"""Trajectory, tolerance and contact condition of an arm motion."""

from __future__ import annotations

from dataclasses import dataclass

from engine.messages import Vector3
from robots.port.arrays import Array


@dataclass(frozen=True, kw_only=True)
class JointTrajectory:
    """A path over time, sampled every `dt_s`: position and velocity of shape (samples, n).

    It starts at the arm's present set point at rest and ends at rest. A hold, cancel or speed
    override slows the playback (time scaling), so the arm never leaves the path.
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
    """Maximum error of the measured joints: on the path, and at the goal within `settle_s`.

    Nearer to the goal than `in_position_rad` an arm is in position. Farther away it gets up to `in_position_s` as long
    as its controller still takes over what friction holds back; then it has reached the goal as near as it gets.
    """

    path_rad: float = 0.15
    goal_rad: float = 0.01
    settle_s: float = 1.0
    in_position_rad: float = 0.0003
    in_position_s: float = 0.2


@dataclass(frozen=True, kw_only=True)
class ContactCondition:
    """Ends a motion early: the environment pushes the tool with `force_n`.

    Attributes:
        force_n: Minimum force.
        direction: Unit vector in the world; only the force along it counts (a force that opposes the motion has
            the opposite direction of the path). Zero for any direction.
    """

    force_n: float
    direction: Vector3 = (0.0, 0.0, 0.0)

"""Where a measured arm is on its path: the share that has passed, the distance from it, and what is left of it."""

from __future__ import annotations

import numpy as np

from robots.port import Array, JointTrajectory

_AHEAD_S = 0.5


class PathTracker:
    """Follows measurements along a trajectory; it never goes back, and looks no further ahead than time allows."""

    def __init__(self, trajectory: JointTrajectory) -> None:
        self._trajectory = trajectory
        self._sample = 0

    @property
    def progress(self) -> float:
        """Passed share of the trajectory's time."""
        last = len(self._trajectory.position_rad) - 1
        return self._sample / last if last else 1.0

    def advance(self, measured_rad: Array, *, passed_s: float) -> float:
        """Take a measurement and return its distance from the path, the largest of all joints.

        Args:
            measured_rad: Measured angles, (n,).
            passed_s: How much of the trajectory's time can have passed at most; half a second is added.
        """
        position = self._trajectory.position_rad
        end = min(len(position), int((passed_s + _AHEAD_S) / self._trajectory.dt_s) + 1)
        window = position[self._sample : max(end, self._sample + 1)]
        distance = np.abs(window - measured_rad).max(axis=1)
        nearest = int(np.argmin(distance))
        self._sample += nearest
        return float(distance[nearest])

    def rest(self, measured_rad: Array) -> JointTrajectory:
        """Return the rest of the trajectory from a measured position near it; its end is always part of it."""
        trajectory = self._trajectory
        after = min(self._sample + 1, len(trajectory.position_rad) - 1)
        zero = np.zeros((1, len(measured_rad)))
        return JointTrajectory(
            dt_s=trajectory.dt_s,
            position_rad=np.vstack((measured_rad[None], trajectory.position_rad[after:])),
            velocity_rad_s=np.vstack((zero, trajectory.velocity_rad_s[after:])),
        )

    @property
    def passed_s(self) -> float:
        """Time of the trajectory at the last measurement."""
        return self._sample * self._trajectory.dt_s

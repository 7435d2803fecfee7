"""Playback of a trajectory with time scaling: it may slow down, stop and resume, but never leaves the path."""

from __future__ import annotations

import numpy as np

from engine.errors import RobotError
from robots.control.arm_state import ArmState
from robots.port import Array, JointTrajectory

SHORTEST_STOP_S = 0.1
"""Minimum time of a start or stop, so that slow motions do not stop abruptly."""

# Stopping uses this share of the joints' acceleration and jerk; the rest is reserved for tracking.
_ACCELERATION_SHARE = 0.9
_JERK_SHARE = 0.85
# A set point that moves by this within a period exceeds no limit.
_SAME_RAD = 1e-7
# While a path that begins with a push p″ gathers pace, its jerk reaches 3 p″s̈.
_FIRST_PACE = 3.0


class TrajectoryPlayback:
    """The set point on a trajectory; s is the trajectory's own time, ṡ = 1 its nominal pace.

    `position`, `velocity` and `acceleration` are the present set point, shape (n,), reused by `step`.

    Args:
        trajectory: The path over time, from rest to rest.
        acceleration_rad_s2: Acceleration limits of the joints, (n,).
        jerk_rad_s3: Jerk limits of the joints, (n,).
        shortest_stop_s: Minimum time from the nominal pace to a stop; it makes slow stops gentle.
    """

    name = "trajectory"
    """For messages."""

    contact = False
    """It ends only at its goal."""
    leads = True
    """The arm follows."""
    failure = ""
    """A path can always be followed."""

    def __init__(
        self,
        trajectory: JointTrajectory,
        *,
        acceleration_rad_s2: Array,
        jerk_rad_s3: Array,
        shortest_stop_s: float = SHORTEST_STOP_S,
    ) -> None:
        self._shortest_stop_s = shortest_stop_s
        from robots.control import kernels

        # Copied: in virtual time these are the arrays of the planner, which may reuse them.
        self._points = np.array(trajectory.position_rad, dtype=np.float64, order="C")
        self._slopes = np.array(trajectory.velocity_rad_s, dtype=np.float64, order="C")
        self._peak = np.abs(self._slopes).max(axis=0)
        self._pass_along = kernels.interpolate_setpoint
        self._advance_pace = kernels.advance_pace
        self._dt_s = trajectory.dt_s
        self._acceleration = acceleration_rad_s2 * _ACCELERATION_SHARE
        self._jerk = jerk_rad_s3 * _JERK_SHARE
        # Time in which the jerk limits allow the acceleration at the start of the path.
        self._first_jerk_s = float((self._first_acceleration() / self._jerk).max())
        self.duration_s = trajectory.duration_s
        self.passed_s = 0.0
        self.pace = 1.0
        self._rate = 0.0
        self._pace = np.zeros(3)
        self.position = self._points[0].copy()
        self.velocity = np.zeros_like(self.position)
        self.acceleration = np.zeros_like(self.position)

    @property
    def at_end(self) -> bool:
        """True at the end of the path."""
        return self.passed_s >= self.duration_s

    @property
    def stopped(self) -> bool:
        """True when the set point stands still, within the path or at its end."""
        return self.pace == 0.0 or self.at_end

    @property
    def moving(self) -> bool:
        """True while the set point moves, and at the end."""
        return self.pace > 0.0 or self.at_end

    @property
    def complete(self) -> bool:
        """True at the end of the path."""
        return self.at_end

    @property
    def progress(self) -> float:
        """Elapsed share of the trajectory's time, 0 to 1."""
        return self.passed_s / self.duration_s if self.duration_s > 0.0 else 1.0

    @property
    def goal(self) -> Array | None:
        """The configuration at the end, shape (n,)."""
        return self._points[-1]

    def data(self) -> bytes:
        """Nothing is recorded."""
        return b""

    @property
    def path(self) -> tuple[Array, Array]:
        """Positions and velocities at the nominal pace, each (samples, n)."""
        return self._points, self._slopes

    def step(self, step_s: float, *, target_pace: float, state: ArmState | None = None) -> None:
        """Advance by `step_s` of real time, changing the pace towards `target_pace` (0 to 1) as fast as allowed."""
        if self.passed_s == 0.0:
            # It starts at rest, where any pace is possible, unless the path begins with a push.
            self.pace, self._rate = (0.0 if self._first_jerk_s > step_s else target_pace), 0.0
        if self.pace == target_pace and self._rate == 0.0:
            self.passed_s = min(self.passed_s + self.pace * step_s, self.duration_s)
        else:
            self._change_pace(step_s, target_pace)
        self._set_point()

    def _change_pace(self, step_s: float, target: float) -> None:
        pace = self._pace
        pace[0], pace[1] = self.pace, self._rate
        self._advance_pace(
            self._points,
            self._slopes,
            *self.located(),
            self._dt_s,
            step_s,
            target,
            1.0 / max(self._shortest_stop_s, _FIRST_PACE * self._first_jerk_s),
            self._acceleration,
            self._jerk,
            self._peak,
            pace,
        )
        self.pace, self._rate = float(pace[0]), float(pace[1])
        self.passed_s = min(self.passed_s + float(pace[2]), self.duration_s)

    def located(self) -> tuple[int, float]:
        """Return the sample before the set point, and the interpolation share to the next one, 0 to 1."""
        last = len(self._points) - 2
        index = min(int(self.passed_s / self._dt_s), last)
        return index, self.passed_s / self._dt_s - index

    def _first_acceleration(self) -> Array:
        first, second = self._slopes[0], self._slopes[1]
        rise = (self._points[1] - self._points[0]) / self._dt_s
        return np.abs(6.0 * rise - 4.0 * first - 2.0 * second) / self._dt_s

    def _set_point(self) -> None:
        if self.at_end:
            self.position[:] = self._points[-1]
            self.velocity[:] = 0.0
            self.acceleration[:] = 0.0
            return
        index, u = self.located()
        self._pass_along(
            self._points,
            self._slopes,
            index,
            u,
            self._dt_s,
            self.pace,
            self.pace**2,
            self._rate,
            self.position,
            self.velocity,
            self.acceleration,
        )


def validate_trajectory(trajectory: JointTrajectory, *, start_rad: Array, joints: tuple[str, ...]) -> JointTrajectory:
    """Return `trajectory` if an arm at the set point `start_rad` can follow it.

    Raises:
        RobotError: wrong shape, a value that is not finite, or it does not start at the set point at rest.
    """
    position, velocity = np.asarray(trajectory.position_rad), np.asarray(trajectory.velocity_rad_s)
    if position.ndim != 2 or position.shape != velocity.shape or position.shape[1] != len(joints) or len(position) < 2:
        raise RobotError(
            f"positions {position.shape} and velocities {velocity.shape} are not a trajectory for {len(joints)} joints",
            hint="give at least two samples, one column per joint",
        )
    if not (np.isfinite(position).all() and np.isfinite(velocity).all() and trajectory.dt_s > 0.0):
        raise RobotError("the trajectory has values that are not finite, or dt_s is not positive")
    gap = np.abs(position[0] - start_rad)
    worst = int(np.argmax(gap))
    if gap[worst] > _SAME_RAD:
        raise RobotError(
            f"the trajectory starts {gap[worst]:.3g} rad from the set point of {joints[worst]}",
            hint="plan from ArmSample.desired_rad",
        )
    if np.abs(velocity[[0, -1]]).max() > 0.01:
        raise RobotError(
            "the trajectory does not start and end at rest", hint="its first and last velocities must be 0"
        )
    return trajectory

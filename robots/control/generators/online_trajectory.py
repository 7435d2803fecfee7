"""Online trajectory generation within position, velocity, acceleration and jerk limits, always able to stop in time."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import ruckig

from robots.model.robot_model import JointLimits
from robots.port import Array

# ruckig has no type stubs: only this file uses it, and returns numpy arrays.
profiles: Any = ruckig

# The rest of the joints' acceleration is reserved for tracking.
_STOP_SHARE = 0.9
_REST = 1e-9
# Slower joints are not sent to their limit, which they would reach only after hours.
_SLOW_RAD_S = 0.01
_SLOW_ROOM_RAD = 1e-4
# Rounding tolerance of a stop that ends exactly at a limit. What is beyond the limit is cut off, in one period: with
# 1e-6 rad that would be a jerk of 1000 rad/s³.
_ROUNDING_RAD = 1e-8
_ANSWER_HZ = 250.0


_State = tuple[list[float], list[float], list[float]]


class OnlineTrajectoryGenerator:
    """A set point advanced by one of `go_to`, `track`, `run`, `run_together` or `brake` in every period.

    Before each step the hardest stop after it is computed; if that stop would pass a joint
    limit, the stop of the previous period is followed instead. So for any request the set
    point stays within the limits. `position`, `velocity` and `acceleration` (its mean over the last
    period), shape (n,), are reused.

    Args:
        limits: Joint limits; a joint that starts beyond a position limit may stay there, but not go farther.
        start: Initial set point, (n,), rad.
        share: Share of the acceleration limits used for motion; stops use 0.9.
    """

    def __init__(self, *, limits: JointLimits, start: Array, share: float = _STOP_SHARE) -> None:
        n = len(start)
        self.lower_rad = np.minimum(limits.lower_rad, start)
        self.upper_rad = np.maximum(limits.upper_rad, start)
        self._jerk = np.array(limits.jerk_rad_s3)
        self._bounds = tuple(
            zip((self.lower_rad - _ROUNDING_RAD).tolist(), (self.upper_rad + _ROUNDING_RAD).tolist(), strict=True)
        )
        self.velocity_rad_s = np.array(limits.velocity_rad_s)
        self.acceleration_rad_s2 = np.array(limits.acceleration_rad_s2) * share
        self._answer_hz = np.minimum(_ANSWER_HZ, self._jerk / (2.0 * self.acceleration_rad_s2))
        self._slowest_answer_hz = float(self._answer_hz.min())
        self.position = np.array(start, dtype=np.float64)
        self.velocity = np.zeros(n)
        self.acceleration = np.zeros(n)
        self._now: _State = (self.position.tolist(), [0.0] * n, [0.0] * n)
        self._solver = profiles.Ruckig(n)
        self._trajectory = profiles.Trajectory(n)
        self._hardest = np.array(limits.acceleration_rad_s2) * _STOP_SHARE
        self._request = self._new_request(self.acceleration_rad_s2, limits)
        self._stop_request = self._new_request(self._hardest, limits)
        self._stop_request.control_interface = profiles.ControlInterface.Velocity
        self._stop, self._next_stop = profiles.Trajectory(n), profiles.Trajectory(n)
        self._stop_start, self._stop_passed_s = self._now[0], 0.0
        self._plan_stop(self._now, self._stop)

    @property
    def at_rest(self) -> bool:
        """True when the set point stands still."""
        return not (self.velocity.any() or any(self._now[2]))

    def place(self, position: Array, velocity: Array, acceleration: Array | None = None) -> None:
        """Continue from this externally produced state, at rest in acceleration if none is given.

        Positions beyond a limit are moved inside.
        """
        self.position[:] = np.minimum(np.maximum(position, self.lower_rad), self.upper_rad)
        self.velocity[:] = np.minimum(np.maximum(velocity, -self.velocity_rad_s), self.velocity_rad_s)
        self.acceleration[:] = 0.0 if acceleration is None else acceleration
        np.minimum(np.maximum(self.acceleration, -self._hardest), self._hardest, out=self.acceleration)
        self._now = (self.position.tolist(), self.velocity.tolist(), self.acceleration.tolist())
        self._stop_start, self._stop_passed_s = self._now[0], 0.0
        self._plan_stop(self._now, self._stop)

    def go_to(self, step_s: float, *, position: Array, pace: float) -> None:
        """Move to `position` (within the limits), every joint as fast as it can at `pace` times its velocity limit."""
        request = self._request
        request.control_interface = profiles.ControlInterface.Position
        request.per_dof_control_interface = None
        request.synchronization = profiles.Synchronization.No
        request.max_velocity = (self.velocity_rad_s * pace).tolist()
        request.target_position = position.tolist()
        request.target_velocity = [0.0] * len(position)
        self._step(step_s)

    def run(self, step_s: float, *, velocity: Array) -> None:
        """Bring every joint independently to its velocity, (n,); it comes to rest at its position limit."""
        request = self._request
        of = profiles.ControlInterface
        room = np.where(velocity > 0.0, self.upper_rad - self.position, self.position - self.lower_rad)
        slow = np.abs(velocity) < _SLOW_RAD_S
        request.control_interface = of.Position
        request.per_dof_control_interface = [of.Velocity if creeps else of.Position for creeps in slow.tolist()]
        request.synchronization = profiles.Synchronization.No
        request.max_velocity = np.minimum(np.abs(velocity) + slow, self.velocity_rad_s).tolist()
        request.target_position = np.where(velocity > 0.0, self.upper_rad, self.lower_rad).tolist()
        request.target_velocity = np.where(slow & (room > _SLOW_ROOM_RAD), velocity, 0.0).tolist()
        self._step(step_s)

    def run_together(self, step_s: float, *, velocity: Array, turning: Array) -> None:
        """Bring the joints to velocities within their limits, along a straight line in velocity space.

        `turning` (n,) is the rate of change of the target velocities, rad/s²; the reached share follows it.
        """
        now, before = np.array(self._now[1]), np.array(self._now[2])
        square = float(velocity @ velocity)
        along = min(1.0, max(0.0, float(now @ velocity) / square)) * turning if square > _REST else np.zeros_like(now)
        rise = (velocity - now) * self._slowest_answer_hz
        rise = along + rise * _share_within(rise, np.maximum(self.acceleration_rad_s2 - np.abs(along), 0.0))
        rise = before + (rise - before) * _share_within(rise - before, self._jerk * step_s)
        self._accelerate(step_s, np.minimum(np.maximum(rise, -self._hardest), self._hardest))

    def track(self, step_s: float, *, position: Array, velocity: Array, acceleration: Array, pace: float) -> None:
        """Follow a smoothly moving point: its position, velocity and acceleration, (n,).

        Time-optimal profiles would turn small corrections into pulses of full jerk.
        """
        fastest = self.velocity_rad_s * pace
        missing = position - self.position
        highest = np.sqrt(self.acceleration_rad_s2 * np.abs(missing))
        target = velocity + np.minimum(np.maximum(self._answer_hz / 4.0 * missing, -highest), highest)
        target = np.minimum(np.maximum(target, -fastest), fastest)
        now, before = np.array(self._now[1]), np.array(self._now[2])
        rise = acceleration + (target - now) * self._answer_hz
        change = self._jerk * step_s
        rise = np.minimum(np.maximum(rise, -self.acceleration_rad_s2), self.acceleration_rad_s2)
        rise = np.minimum(np.maximum(rise, before - change), before + change)
        self._accelerate(step_s, rise)

    def brake(self, step_s: float) -> None:
        """Come to rest, every joint as fast as it can."""
        before = self.velocity.copy()
        self._stop_passed_s += step_s
        moved, velocity, acceleration = self._stop.at_time(self._stop_passed_s)
        position = [start + distance for start, distance in zip(self._stop_start, moved, strict=True)]
        self._now = (position, velocity, acceleration)
        self._take(before, step_s)

    def _new_request(self, acceleration: Array, limits: JointLimits) -> Any:
        request = profiles.InputParameter(len(acceleration))
        request.max_velocity = self.velocity_rad_s.tolist()
        request.max_acceleration = acceleration.tolist()
        request.max_jerk = list(limits.jerk_rad_s3)
        request.synchronization = profiles.Synchronization.No
        return request

    def _step(self, step_s: float) -> None:
        request = self._request
        request.current_position, request.current_velocity, request.current_acceleration = self._now
        try:
            self._solver.calculate(request, self._trajectory)
        except (profiles.RuckigError, ValueError):
            # Rounding makes ruckig fail from some states; the verified stop leaves them within a period.
            self.brake(step_s)
            return
        self._accept(self._trajectory.at_time(step_s), step_s)

    def _accelerate(self, step_s: float, rise: Array) -> None:
        """Change the acceleration to `rise` within the period, if no velocity limit is passed now or later."""
        position, now, before = (np.array(values) for values in self._now)
        faster = now + (before + rise) * (step_s / 2.0)
        peak = np.abs(faster + rise * np.abs(rise) / (2.0 * self._jerk))
        if (peak > np.maximum(self.velocity_rad_s, np.abs(now))).any():
            self.brake(step_s)
            return
        farther = position + now * step_s + (2.0 * before + rise) * (step_s * step_s / 6.0)
        self._accept((farther.tolist(), faster.tolist(), rise.tolist()), step_s)

    def _accept(self, candidate: _State, step_s: float) -> None:
        """Accept the candidate if the arm can stop from it before its limits."""
        if not math.isfinite(sum(map(sum, candidate))):
            # The request overflows; the verified stop does not.
            self.brake(step_s)
            return
        self._plan_stop(candidate, self._next_stop)
        if not self._stops_inside(candidate[0], self._next_stop):
            self.brake(step_s)
            return
        before = self.velocity.copy()
        self._now, self._stop_start = candidate, candidate[0]
        self._stop, self._next_stop, self._stop_passed_s = self._next_stop, self._stop, 0.0
        self._take(before, step_s)

    def _plan_stop(self, state: _State, stop: Any) -> None:
        request = self._stop_request
        # ruckig includes position 0 in the extent of a stop: stops are planned from there.
        _, request.current_velocity, request.current_acceleration = state
        self._solver.calculate(request, stop)

    def _stops_inside(self, start: list[float], stop: Any) -> bool:
        return all(
            angle + bound.min >= low and angle + bound.max <= high
            for angle, bound, (low, high) in zip(start, stop.position_extrema, self._bounds, strict=True)
        )

    def _take(self, before: Array, step_s: float) -> None:
        position, velocity, acceleration = self._now
        if all(abs(v) < _REST and abs(a) < _REST for v, a in zip(velocity, acceleration, strict=True)):
            velocity = acceleration = [0.0] * len(velocity)
            self._now = (position, velocity, acceleration)
        np.minimum(position, self.upper_rad, out=self.position)
        np.maximum(self.position, self.lower_rad, out=self.position)
        self.velocity[:] = velocity
        np.subtract(self.velocity, before, out=self.acceleration)
        self.acceleration /= step_s


def _share_within(values: Array, limit: Array) -> float:
    """Return the largest share, at most 1, at which all values are within the limits."""
    return min(1.0, float((limit / np.maximum(np.abs(values), _REST)).min()))

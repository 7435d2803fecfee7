"""Direct joint control: the set point follows joint angles streamed at any rate (RCL 4.3.8)."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.control.generators.setpoint_stream import SetpointStream
from robots.model.robot_model import JointLimits
from robots.port import Array

# Values farther apart in time are single targets, not a stream to interpolate.
_LONGEST_PERIOD_S = 0.1
_PERIOD_SMOOTHING = 0.2
# The motion to a value takes this many periods, so that a late next value causes no stop.
_PERIODS = 1.5
_LEAST_LAG_STEPS = 2.0
_STANDS_RAD_S = 1e-4
_BEYOND_RAD = 1e-6


class JointStreamGenerator(SetpointStream):
    """A stream of joint angles, (n,), rad.

    A continuous stream is interpolated linearly, so the set point follows smoothly
    one and a half periods later; single values are approached as fast as allowed. Angles beyond a
    limit are clipped, and `warning` records it.

    Args:
        limits: Joint limits.
        joints: Joint names, for the warning.
        start: The arm's set point, at rest, (n,), rad.
        watchdog_s: Maximum silence before the set point comes to rest.
    """

    name = "joint stream"
    """For messages."""

    def __init__(self, *, limits: JointLimits, joints: tuple[str, ...], start: Array, watchdog_s: float) -> None:
        super().__init__(
            shaper=OnlineTrajectoryGenerator(limits=limits, start=start), values=len(start), watchdog_s=watchdog_s
        )
        self._joints = joints
        self._from = self.position.copy()
        self._reference = self.position.copy()
        self._smoothed = self.position.copy()
        self._rate = np.zeros(len(start))
        self._rise = np.zeros(len(start))
        self._period_s = 0.0
        self._since_s = 0.0
        self.warning = ""

    def receive(self, values: Array, *, age_s: float = 0.0) -> None:
        """Set the target angles; the watchdog counts from when they were sent, `age_s` ago."""
        gap_s = self._silence_s
        self._remember_clipping(values)
        super().receive(np.clip(values, self._shaper.lower_rad, self._shaper.upper_rad), age_s=age_s)
        if gap_s > min(_LONGEST_PERIOD_S, self._watchdog_s):
            self._period_s = 0.0
        elif self._period_s == 0.0:
            self._period_s = gap_s
            self._start_here()
        elif gap_s > 0.0:
            self._period_s += _PERIOD_SMOOTHING * (gap_s - self._period_s)
        self._from[:] = self._reference
        self._since_s = 0.0

    def data(self) -> bytes:
        """Return the warning as UTF-8 text; empty without clipping."""
        return self.warning.encode()

    def _go(self, step_s: float, *, pace: float, state: ArmState) -> None:
        self._since_s += step_s
        ramp_s = _PERIODS * self._period_s
        share = self._since_s / ramp_s if self._since_s < ramp_s else 1.0
        self._reference = self._from + share * (self._received - self._from)
        self._smooth(self._reference, step_s)
        shaper = self._shaper
        if ramp_s == 0.0 or float(np.abs(self._rate).max()) < _STANDS_RAD_S:
            shaper.go_to(step_s, position=self._received, pace=pace)
        else:
            shaper.track(step_s, position=self._smoothed, velocity=self._rate, acceleration=self._rise, pace=pace)

    def _smooth(self, reference: Array, step_s: float) -> None:
        """Advance the smoothed reference by the exact step of a critically damped filter."""
        lag_s = max(self._period_s / 2.0, _LEAST_LAG_STEPS * step_s)
        decay = np.exp(-step_s / lag_s)
        error = self._smoothed - reference
        slope = self._rate + error / lag_s
        later = error + slope * step_s
        self._smoothed = reference + later * decay
        before = self._rate
        self._rate = (slope - later / lag_s) * decay
        self._rise = (self._rate - before) / step_s

    def _rest(self, step_s: float) -> None:
        super()._rest(step_s)
        self._start_here()

    def _start_here(self) -> None:
        """Start the line to the next values at the set point."""
        self._reference = self.position.copy()
        self._smoothed = self.position.copy()
        self._rate = self.velocity.copy()

    def _remember_clipping(self, values: Array) -> None:
        beyond = np.maximum(values - self._shaper.upper_rad, self._shaper.lower_rad - values)
        worst = int(np.argmax(beyond))
        if not self.warning and beyond[worst] > _BEYOND_RAD:
            limit = self._shaper.upper_rad if values[worst] > self.position[worst] else self._shaper.lower_rad
            clipped = f"{values[worst]:.3f} rad, clipped to {limit[worst]:.3f} rad"
            self.warning = f"set point of {self._joints[worst]} beyond its limit: {clipped}"

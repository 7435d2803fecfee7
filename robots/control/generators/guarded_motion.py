"""Move until contact: any motion that brakes when the environment pushes back."""

from __future__ import annotations

import math

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.motion_generator import MotionGenerator
from robots.port import Array, ContactCondition

GUARDED_STOP_S = 0.005
"""Minimum stop time of a guarded motion, for `TrajectoryPlayback(shortest_stop_s=…)`."""

_TARE_S = 0.01
_DEBOUNCE_S = 0.003


class GuardedMotion:
    """Implements `MotionGenerator`: `inner`, ended by a contact.

    The contact force is the tool force minus its mean over the first 10 ms, so a motion that starts under
    contact or load detects only what is added. It must last for 3 ms. At a contact `inner`
    brakes as hard as it can; use `TrajectoryPlayback(…, shortest_stop_s=GUARDED_STOP_S)`. Contacts count from
    the start of the motion until it has settled at its end, but not while it is held.

    Args:
        inner: The motion.
        contact: The contact that ends it.
    """

    name = "guarded motion"
    """For messages."""

    def __init__(self, inner: MotionGenerator, contact: ContactCondition) -> None:
        self.inner = inner
        """The motion that a contact ends."""
        self._force_n = contact.force_n
        self._direction = np.array(contact.direction, dtype=np.float64)
        self._any_direction = not self._direction.any()
        self._tare = np.zeros(3)
        self._tare_s = 0.0
        self._pushed_s = 0.0
        self._touched = False
        self._peak_n = 0.0
        self.position = inner.position
        self.velocity = inner.velocity
        self.acceleration = inner.acceleration

    @property
    def stopped(self) -> bool:
        """True when the set point stands still."""
        return self.inner.stopped

    @property
    def moving(self) -> bool:
        """True once it moves again, or nothing is left to do."""
        return self._touched or self.inner.moving

    @property
    def complete(self) -> bool:
        """True at the end of the motion, and after the stop at a contact."""
        return self.inner.complete or (self._touched and self.inner.stopped)

    @property
    def contact(self) -> bool:
        """True after the contact."""
        return self._touched

    @property
    def progress(self) -> float:
        """Completed share of the motion."""
        return self.inner.progress

    @property
    def goal(self) -> Array | None:
        """Goal of the inner motion; None after a contact."""
        return None if self._touched else self.inner.goal

    @property
    def leads(self) -> bool:
        """As the inner motion."""
        return self.inner.leads

    @property
    def failure(self) -> str:
        """As the inner motion."""
        return self.inner.failure

    def data(self) -> bytes:
        """Return the greatest contact force from the start on, N, encoded; see `decode_peak_n`."""
        return np.float64(self._peak_n).tobytes()

    def step(self, step_s: float, *, target_pace: float, state: ArmState) -> None:
        """Advance by `step_s`, or brake after a contact."""
        pushed = self._push_n(step_s, state.wrench[:3])
        self._peak_n = max(self._peak_n, pushed)
        if not self._touched and target_pace > 0.0:
            self._pushed_s = self._pushed_s + step_s if pushed >= self._force_n else 0.0
            self._touched = self._pushed_s >= _DEBOUNCE_S
        self.inner.step(step_s, target_pace=0.0 if self._touched else target_pace, state=state)

    def _push_n(self, step_s: float, force: Array) -> float:
        """Return the contact force of this period, 0 while the tare is measured."""
        if self._tare_s < _TARE_S:
            self._tare_s += step_s
            self._tare += (force - self._tare) * min(1.0, step_s / self._tare_s)
            return 0.0
        added = force - self._tare
        return math.sqrt(float(added @ added)) if self._any_direction else float(added @ self._direction)


def decode_peak_n(data: bytes) -> float:
    """Return the greatest contact force of a guarded motion from its recorded data."""
    return float(np.frombuffer(data)[0])

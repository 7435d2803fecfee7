"""Base of all stream generators: inputs, watchdog, hold, and coming to rest to finish."""

from __future__ import annotations

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.generators.online_trajectory import OnlineTrajectoryGenerator
from robots.port import Array


class SetpointStream:
    """Base class of stream generators: `_go` defines what to do with the latest values.

    It comes to rest within the limits when held, when no values arrived for longer than
    `watchdog_s`, and to finish; after a silence it resumes with the next value.
    `position`, `velocity` and `acceleration` are the present set point, shape (n,), reused by `step`.

    Args:
        shaper: Generates the set point, starting at the arm's present one.
        values: Number of values per message.
        watchdog_s: Maximum silence.
    """

    name = "stream"
    """For messages."""

    contact = False
    """It ends on `finish`."""
    goal: Array | None = None
    """It may end anywhere."""
    failure = ""
    """It can always come to rest."""

    def __init__(self, *, shaper: OnlineTrajectoryGenerator, values: int, watchdog_s: float) -> None:
        self._shaper = shaper
        self._watchdog_s = watchdog_s
        self._received = np.zeros(values)
        self._silence_s = np.inf
        self._finishing = False
        self._held = False
        self.position = shaper.position
        self.velocity = shaper.velocity
        self.acceleration = shaper.acceleration

    @property
    def stopped(self) -> bool:
        """True when the set point stands still."""
        return self._shaper.at_rest

    @property
    def moving(self) -> bool:
        """True unless held: a stream counts as moving even at zero velocity."""
        return not self._held

    @property
    def complete(self) -> bool:
        """True when finished and at rest."""
        return self._finishing and self.stopped

    @property
    def progress(self) -> float:
        """0 until it is complete, then 1: a stream has no length."""
        return 1.0 if self.complete else 0.0

    @property
    def leads(self) -> bool:
        """True: the arm follows."""
        return True

    def receive(self, values: Array, *, age_s: float = 0.0) -> None:
        """Set the latest values; the watchdog counts from when they were sent, `age_s` ago."""
        self._received[:] = values
        self._silence_s = age_s

    def finish(self) -> None:
        """Come to rest, then be complete."""
        self._finishing = True

    def step(self, step_s: float, *, target_pace: float, state: ArmState) -> None:
        """Advance the set point by `step_s` of real time; speeds are limited to `target_pace` of their limits."""
        silent = self._silence_s > self._watchdog_s
        self._silence_s += step_s
        self._held = target_pace == 0.0
        if self._held or self._finishing or silent:
            self._rest(step_s)
        else:
            self._go(step_s, pace=target_pace, state=state)

    def data(self) -> bytes:
        """Nothing is recorded."""
        return b""

    def _rest(self, step_s: float) -> None:
        self._shaper.brake(step_s)

    def _go(self, step_s: float, *, pace: float, state: ArmState) -> None:
        raise NotImplementedError

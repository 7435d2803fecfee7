"""The contract between the engine and a process that controls devices, simulated or real.

- *The engine is silent* (its counter has not changed for `engine_silence_s`, 0.2 s unless the cell says otherwise:
  its loop is blocked, the process is suspended or starved): every motion and drive decelerates within its braking
  limits. Each motion ends as FAILED, at rest, with the cause and the measured silence. Nothing resumes when the
  engine is back; new motions are accepted again from its next pulse on, and fail with the cause before it.
- *The engine is gone* (the socket is closed, as with `kill -9`): the same at once, and the process ends as soon as
  everything is at rest.
- *Stop*: equals a cancel of every motion; it does not wait for the engine.
- *Its own pulse*: it increments its counter once per control period and nowhere else, so that a process whose
  control loop stalls is silent. The engine then declares it lost within 0.3 s, kills it, and fails its motions.
- Held objects stay held: brakes and tools keep their state.

`EngineMonitor` implements the engine silence and the process's own pulse; a driver's process calls `look` once per
control period.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from robots.port.heartbeat import ENGINE_SILENCE_S, Heartbeat, SilenceMonitor

_LONGEST_GAP_S = 0.05
ENGINE_GONE = "the engine has ended"


class ControlledDevices(Protocol):
    """All devices of one control process."""

    @property
    def at_rest(self) -> bool:
        """Whether no motion is active and all measured speeds are at rest."""
        ...

    def brake(self, cause: str) -> None:
        """Decelerate every motion within its limits, ending it as FAILED with `cause`; may be called repeatedly."""
        ...


class EngineMonitor:
    """The control process's side of the heartbeat: its own pulse, the engine's silence and the time at rest.

    Args:
        heartbeat: Shared with the engine.
        devices: The devices that are brought to rest.
        limit_s: Maximum silence of the engine.
        log: Writes a log line; must not block.
    """

    def __init__(
        self,
        heartbeat: Heartbeat,
        devices: ControlledDevices,
        *,
        limit_s: float = ENGINE_SILENCE_S,
        log: Callable[[str], None],
    ) -> None:
        self._heartbeat = heartbeat
        self._devices = devices
        self._silence = SilenceMonitor(limit_s=limit_s, longest_gap_s=_LONGEST_GAP_S)
        self._log = log
        self._is_gone = False
        self._is_heard = True
        self._braking_since_s: float | None = None
        self._braked_for = ""
        self._was_at_rest = False

    def look(self, now_s: float) -> None:
        """Increment the counter, and brake while the engine is silent; once per control period, on CLOCK_MONOTONIC."""
        self._heartbeat.beat_control()
        if self._is_gone or self._silence.look(self._heartbeat.engine_count, now_s):
            self._brake(now_s)
        else:
            self._is_heard = True
        self._report_rest(now_s)

    def engine_is_gone(self) -> None:
        """Brake permanently from the next look on: the connection to the engine has ended."""
        self._is_gone = True

    def _brake(self, now_s: float) -> None:
        cause = ENGINE_GONE if self._is_gone else f"the engine has been silent for {self._silence.silent_s:.1f} s"
        if self._is_heard and not self._devices.at_rest:
            self._braking_since_s, self._braked_for = now_s, cause
        self._is_heard = False
        self._devices.brake(cause)

    def _report_rest(self, now_s: float) -> None:
        at_rest = self._devices.at_rest
        if at_rest != self._was_at_rest:
            self._was_at_rest = at_rest
            self._heartbeat.report_at_rest(round(now_s * 1e9) if at_rest else 0)
        if at_rest and self._braking_since_s is not None:
            took_s, self._braking_since_s = now_s - self._braking_since_s, None
            self._log(f"{self._braked_for}; everything came to rest {took_s:.3f} s later, at {now_s:.3f} s (monotonic)")

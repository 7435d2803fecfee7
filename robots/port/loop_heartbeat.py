"""The engine's side of a heartbeat: pulses from the event loop, and looks at the control process's counter."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from robots.port.heartbeat import CONTROL_SILENCE_S, PULSE_S, Heartbeat, SilenceMonitor

_LONGEST_GAP_S = 0.06


class LoopHeartbeat:
    """Pulses from a timer of the running loop, so that a blocked loop is silent.

    Args:
        heartbeat: Shared with the control process, whose loop is running.
        limit_s: Maximum silence of the control process, in time in which this loop runs.
        on_silence: Called once with the measured silence; the pulses end with it.
    """

    def __init__(
        self, heartbeat: Heartbeat, *, limit_s: float = CONTROL_SILENCE_S, on_silence: Callable[[float], None]
    ) -> None:
        self._heartbeat = heartbeat
        self._silence = SilenceMonitor(limit_s=limit_s, longest_gap_s=_LONGEST_GAP_S)
        self._on_silence = on_silence
        self._timer: asyncio.TimerHandle | None = None

    def begin(self) -> None:
        """Start pulses and looks; the first pulse arms the control process's monitor."""
        self._turn()

    def pulse(self) -> None:
        """Pulse between two timer ticks: a loop that sends a command is alive."""
        if self._timer is not None:
            self._heartbeat.beat_engine()

    def end(self) -> None:
        """Stop the pulses."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _turn(self) -> None:
        loop = asyncio.get_running_loop()
        self._heartbeat.beat_engine()
        if self._silence.look(self._heartbeat.control_count, loop.time()):
            self._timer = None
            self._on_silence(self._silence.silent_s)
        else:
            self._timer = loop.call_later(PULSE_S, self._turn)

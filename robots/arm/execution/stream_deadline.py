"""Finishes a stream after a duration; time in which its goal is held does not count."""

from __future__ import annotations

import asyncio
from typing import Any

from engine.bus import ActiveGoal, GoalStatus
from engine.clock import Clock
from robots.port import MotionStream
from robots.supervise_goal import FEEDBACK_S


class StreamDeadline:
    """Deadline of a stream: call `look` at least at every feedback; `restart` resets the time.

    Args:
        stream: The stream to finish.
        handle: Its goal.
        clock: The arm's clock.
        duration_s: Time until the deadline; None for no deadline.
    """

    def __init__(
        self, stream: MotionStream, handle: ActiveGoal[Any], *, clock: Clock, duration_s: float | None
    ) -> None:
        self._stream = stream
        self._handle = handle
        self._clock = clock
        self._duration_s = duration_s
        self._counted_until_s = clock.now_s()
        self._timer: asyncio.TimerHandle | None = None
        self.passed_s = 0.0

    def restart(self) -> None:
        """Restart the time from now."""
        self.close()
        self.passed_s, self._counted_until_s = 0.0, self._clock.now_s()

    def look(self) -> None:
        """Add the time since the last call, and finish the stream at the deadline."""
        now_s = self._clock.now_s()
        if self._handle.status is not GoalStatus.HELD:
            self.passed_s += now_s - self._counted_until_s
        self._counted_until_s = now_s
        if self._duration_s is None or self._timer is not None:
            return
        left_s = self._duration_s - self.passed_s
        if left_s < FEEDBACK_S:
            self._timer = asyncio.get_running_loop().call_later(max(0.0, left_s), self._stream.finish)

    def close(self) -> None:
        """Disarm the deadline; the stream has ended."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

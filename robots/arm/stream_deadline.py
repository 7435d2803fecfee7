"""Ends a stream after so much time under way; time in which its goal is held does not count."""

from __future__ import annotations

import asyncio
from typing import Any

from engine.bus import ActiveGoal, GoalStatus
from engine.clock import Clock
from robots.port import MotionStream
from robots.supervise_goal import FEEDBACK_S


class StreamDeadline:
    """Call `look` at least at every feedback; `restart` begins anew.

    Args:
        stream: What is finished.
        handle: Its goal.
        duration_s: After which time; None for never.
    """

    def __init__(
        self, stream: MotionStream, handle: ActiveGoal[Any], *, clock: Clock, duration_s: float | None
    ) -> None:
        self._stream = stream
        self._handle = handle
        self._clock = clock
        self._duration_s = duration_s
        self._looked_s = clock.now_s()
        self._last: asyncio.TimerHandle | None = None
        self.passed_s = 0.0

    def restart(self) -> None:
        """Count from now."""
        self.close()
        self.passed_s, self._looked_s = 0.0, self._clock.now_s()

    def look(self) -> None:
        """Count the time since the last look, and finish the stream when it is over."""
        now_s = self._clock.now_s()
        if self._handle.status is not GoalStatus.HELD:
            self.passed_s += now_s - self._looked_s
        self._looked_s = now_s
        if self._duration_s is None or self._last is not None:
            return
        left_s = self._duration_s - self.passed_s
        if left_s < FEEDBACK_S:
            self._last = asyncio.get_running_loop().call_later(max(0.0, left_s), self._stream.finish)

    def close(self) -> None:
        """Finish nothing any more; the stream has ended."""
        if self._last is not None:
            self._last.cancel()
            self._last = None

"""A timer of one run that is suspended while its branch is held."""

from __future__ import annotations

import asyncio


class Timer:
    """Completes `future` after `duration_s`, excluding the time in which it is held; used on the loop thread.

    Args:
        path: The path of its node.
        duration_s: The duration, 0 or more.
        held: Whether it starts held.
    """

    __slots__ = ("_due_s", "_handle", "_left_s", "_loop", "future", "path", "since_s")

    def __init__(self, path: str, duration_s: float, *, held: bool) -> None:
        self.path = path
        self._loop = asyncio.get_running_loop()
        self.since_s = self._loop.time()
        """The start time, on the clock of the loop."""
        self.future: asyncio.Future[None] = self._loop.create_future()
        self._left_s = duration_s
        self._due_s = 0.0
        self._handle: asyncio.TimerHandle | None = None
        if not held:
            self.resume()

    def hold(self) -> None:
        """Suspend the timer."""
        if self._handle is not None:
            self._left_s = max(0.0, self._due_s - self._loop.time())
            self.cancel()

    def resume(self) -> None:
        """Resume the timer."""
        if self._handle is None and not self.future.done():
            self._due_s = self._loop.time() + self._left_s
            self._handle = self._loop.call_at(self._due_s, self._expire)

    def cancel(self) -> None:
        """Cancel the timer."""
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None

    def _expire(self) -> None:
        self._handle = None
        if not self.future.done():
            self.future.set_result(None)

"""A timer of one run that stands still while the branch it belongs to is held."""

from __future__ import annotations

import asyncio


class Timer:
    """Completes `future` once `duration_s` has passed in which it was not held; used on the loop thread.

    Args:
        path: The node it belongs to.
        duration_s: How long, 0 or more.
        held: Whether it begins held.
    """

    __slots__ = ("_due_s", "_handle", "_left_s", "_loop", "future", "path", "since_s")

    def __init__(self, path: str, duration_s: float, *, held: bool) -> None:
        self.path = path
        self._loop = asyncio.get_running_loop()
        self.since_s = self._loop.time()
        """When it was set, on the time of the loop."""
        self.future: asyncio.Future[None] = self._loop.create_future()
        self._left_s = duration_s
        self._due_s = 0.0
        self._handle: asyncio.TimerHandle | None = None
        if not held:
            self.resume()

    def hold(self) -> None:
        """Stand still."""
        if self._handle is not None:
            self._left_s = max(0.0, self._due_s - self._loop.time())
            self.cancel()

    def resume(self) -> None:
        """Run on."""
        if self._handle is None and not self.future.done():
            self._due_s = self._loop.time() + self._left_s
            self._handle = self._loop.call_at(self._due_s, self._ring)

    def cancel(self) -> None:
        """Never ring."""
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None

    def _ring(self) -> None:
        self._handle = None
        if not self.future.done():
            self.future.set_result(None)

"""Timers of the decorators of one tree: set during a tick, started when the tick is executed.

A timer of a decorator that is entered while other leaves clean up starts when they are finished, like its leaves.
Timers are suspended while their branch is held.
"""

from __future__ import annotations

from asyncio import Future
from collections.abc import Callable

from engine.runtime.nodes.execution import Execution
from engine.runtime.scheduling.timer import Timer


class TreeTimers:
    """At most one timer for each node, by path; belongs to one activation of a tree.

    Args:
        execution: Provides timers that are suspended while held.
        wake: Called when a timer has expired.
    """

    def __init__(self, execution: Execution, wake: Callable[[], None]) -> None:
        self._execution = execution
        self._wake = wake
        self._set: dict[str, float] = {}
        self._running: dict[str, Timer] = {}
        self.again: dict[str, None] = {}
        """The nodes that request another tick at once, in order of request."""
        self.rang = False
        """Whether a timer has expired since the last tick."""

    @property
    def timers(self) -> tuple[Timer, ...]:
        """The running timers."""
        return tuple(self._running.values())

    @property
    def due(self) -> bool:
        """Whether a tick is due."""
        return self.rang or bool(self.again)

    def follow(self) -> None:
        """Clear what was due, as a tick follows."""
        self.rang = False
        self.again.clear()

    def call_again(self, path: str) -> None:
        """Request another tick at once, unless the node is dropped in this tick."""
        self.again[path] = None

    def set(self, path: str, after_s: float) -> None:
        """Set a timer that expires `after_s` after this tick is executed; replaces an earlier timer of the node."""
        self.drop(path)
        self._set[path] = after_s

    def pending(self, path: str) -> bool:
        """Return whether a timer of the node is set and has not expired."""
        timer = self._running.get(path)
        return path in self._set or (timer is not None and not timer.future.done())

    def drop(self, path: str) -> None:
        """Drop the timer and tick request of a node, if any."""
        self.again.pop(path, None)
        self._set.pop(path, None)
        timer = self._running.pop(path, None)
        if timer is not None:
            self._execution.branch_holds.drop(timer)

    def begin(self) -> None:
        """Start the timers that were set in this tick."""
        for path, after_s in self._set.items():
            self._execution.waits.add_timed(path, after_s)
            timer = self._running[path] = self._execution.branch_holds.timer(path, after_s)
            timer.future.add_done_callback(self._expire)
        self._set.clear()

    def close(self) -> None:
        """Drop all timers."""
        for path in (*self._set, *self._running):
            self.drop(path)

    def _expire(self, _: Future[None]) -> None:
        self.rang = True
        self._wake()

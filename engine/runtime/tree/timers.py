"""Timers of the decorators of one tree: set during a tick, running once the tick is carried out.

A decorator that is entered while others are still cleaning up begins to count when they are done,
as its leaves begin only then. Timers stand still while their branch is held.
"""

from __future__ import annotations

from asyncio import Future
from collections.abc import Callable

from engine.runtime.nodes.execution import Execution
from engine.runtime.scheduling.timer import Timer


class TreeTimers:
    """One timer for each part at most, by path; belongs to one activation of a tree.

    Args:
        execution: Gives timers that stand still while held.
        wake: Called when one has rung.
    """

    def __init__(self, execution: Execution, wake: Callable[[], None]) -> None:
        self._execution = execution
        self._wake = wake
        self._set: dict[str, float] = {}
        self._running: dict[str, Timer] = {}
        self.again: dict[str, None] = {}
        """The parts that want another tick at once, in the order in which they asked."""
        self.rang = False
        """Whether one has rung that no tick has followed yet."""

    @property
    def timers(self) -> tuple[Timer, ...]:
        """Those that are set."""
        return tuple(self._running.values())

    @property
    def due(self) -> bool:
        """Whether there is a reason to tick."""
        return self.rang or bool(self.again)

    def follow(self) -> None:
        """A tick follows: what was due is no more."""
        self.rang = False
        self.again.clear()

    def call_again(self, path: str) -> None:
        """Have the tree ticked again at once, unless the part is dropped in this tick."""
        self.again[path] = None

    def set(self, path: str, after_s: float) -> None:
        """Have the part woken `after_s` after this tick is carried out; replaces what was set before."""
        self.drop(path)
        self._set[path] = after_s

    def pending(self, path: str) -> bool:
        """Tell whether a timer of the part is set and has not rung."""
        timer = self._running.get(path)
        return path in self._set or (timer is not None and not timer.future.done())

    def drop(self, path: str) -> None:
        """Forget what a part has set or called for, if anything."""
        self.again.pop(path, None)
        self._set.pop(path, None)
        timer = self._running.pop(path, None)
        if timer is not None:
            self._execution.branch_holds.drop(timer)

    def begin(self) -> None:
        """Let run what was set in this tick."""
        for path, after_s in self._set.items():
            self._execution.waits.add_timed(path, after_s)
            timer = self._running[path] = self._execution.branch_holds.timer(path, after_s)
            timer.future.add_done_callback(self._ring)
        self._set.clear()

    def close(self) -> None:
        """Forget all."""
        for path in (*self._set, *self._running):
            self.drop(path)

    def _ring(self, _: Future[None]) -> None:
        self.rang = True
        self._wake()

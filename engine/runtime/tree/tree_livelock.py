"""Detects trees that poll in virtual time for something that can no longer change (a livelock)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable

from engine.clock import VirtualLoop
from engine.errors import StateError
from engine.runtime.nodes.execution import Execution
from engine.runtime.scheduling.timer import Timer

_LOOK_EVERY = 1_000


class TreeLivelockDetector:
    """Counts what one activation of a tree asks because of its own timers alone.

    On a real clock somebody may always come. In virtual time there is nobody else where no other
    timer is set, no simulation is busy and nothing outside is waited for: then it would go on for ever.

    Args:
        path: The tree.
        execution: The run.
        timers: Gives those of the tree that are set.
    """

    def __init__(self, path: str, execution: Execution, timers: Callable[[], Iterable[Timer]]) -> None:
        self._path = path
        self._execution = execution
        self._timers = timers
        self._count = 0

    def forget(self) -> None:
        """Begin to count anew: something else has happened."""
        self._count = 0

    def count(self, asked: Callable[[], str]) -> None:
        """Count once more that a timer of the tree has rung.

        Args:
            asked: Names what was asked, for the error.

        Raises:
            StateError: it was in vain too often.
        """
        self._count += 1
        loop = asyncio.get_running_loop()
        if self._count % _LOOK_EVERY or not isinstance(loop, VirtualLoop):
            return
        timers = self._execution.branch_holds.timers
        own = {id(timer) for timer in self._timers()}
        if any(id(timer) not in own for timer in timers) or loop.expects_more_than(len(timers)):
            self._count = 0
        elif self._count >= self._execution.polling_limit:
            raise StateError(
                f"asked {asked()} again {self._count} times, and nothing else can happen any more",
                where=self._path,
                hint="let something end it, such as a timeout",
            )

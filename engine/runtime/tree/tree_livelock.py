"""Detects trees that poll in virtual time for a condition that can no longer change (a livelock)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable

from engine.clock import VirtualLoop
from engine.errors import StateError
from engine.runtime.nodes.execution import Execution
from engine.runtime.scheduling.timer import Timer

_LOOK_EVERY = 1_000


class TreeLivelockDetector:
    """Counts ticks and observations of one activation of a tree that only its own timers cause.

    On a real clock an external event is always possible. In virtual time there is none where no other timer is set, no
    simulation is busy and nothing external is awaited: then the tree would poll forever.

    Args:
        path: The path of the tree.
        execution: The execution of the run.
        timers: Returns the running timers of the tree.
    """

    def __init__(self, path: str, execution: Execution, timers: Callable[[], Iterable[Timer]]) -> None:
        self._path = path
        self._execution = execution
        self._timers = timers
        self._count = 0

    def forget(self) -> None:
        """Reset the count, as something else has happened."""
        self._count = 0

    def count(self, asked: Callable[[], str]) -> None:
        """Count an expired timer of the tree.

        Args:
            asked: Returns the names of the ticked nodes, for the error.

        Raises:
            StateError: the limit is reached without progress.
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
                f"ticked {asked()} again {self._count} times, and nothing else can happen",
                where=self._path,
                hint="add something that ends it, such as a timeout",
            )

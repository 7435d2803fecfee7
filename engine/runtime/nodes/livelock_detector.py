"""Detects loops that poll in virtual time for something that can no longer change (a livelock)."""

from __future__ import annotations

import asyncio

from engine.node_path import is_inside
from engine.runtime.nodes.execution import Execution

_LOOK_EVERY = 1_000


class LivelockDetector:
    """Watches one loop of a run in virtual time.

    What a state does next depends on userdata, on what it asked of the bus, on the run's random numbers and on the
    clock. Where none of that was touched by anybody while a loop went round many times, no node was entered for the
    first time, and nobody waits for longer than some of its rounds, it goes round for ever.

    Args:
        path: The container that loops.
        execution: Of the run.
    """

    def __init__(self, path: str, execution: Execution) -> None:
        self._path = path
        self._execution = execution
        self._loop = asyncio.get_running_loop()
        self._steps = 0
        self._looked = self._moment()
        self._since_s = self._looked[0]

    def step(self) -> float | None:
        """Count a step; return how much time has passed in vain once there were enough of them."""
        self._steps += 1
        if self._steps % _LOOK_EVERY:
            return None
        before, self._looked = self._looked, self._moment()
        if before[1:] != self._looked[1:] or not self._all_wait_for_timers(since_s=before[0]):
            self._steps = 0
            self._since_s = self._looked[0]
            return None
        return self._looked[0] - self._since_s if self._steps >= self._execution.polling_limit else None

    def _moment(self) -> tuple[float, int, int]:
        """Return the time, how often something was touched, and how many nodes were ever entered."""
        return self._loop.time(), self._execution.progress_count, len(self._execution.visits)

    def _all_wait_for_timers(self, *, since_s: float) -> bool:
        """Tell whether every active state waits for a timer, and none for one that was set by the last look already."""
        timers = self._execution.branch_holds.timers
        if any(timer.since_s <= since_s for timer in timers):
            return False
        active = self._execution.activity.nodes
        leaves = (path for path in active if not any(other != path and is_inside(path, other) for other in active))
        timed = {timer.path for timer in timers}
        # The loop itself is between two of its states.
        return all(path in timed or is_inside(path, self._path) for path in leaves)

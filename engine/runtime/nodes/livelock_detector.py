"""Detects loops that poll in virtual time for a condition that can no longer change (a livelock)."""

from __future__ import annotations

import asyncio

from engine.node_path import is_inside
from engine.runtime.nodes.execution import Execution

_LOOK_EVERY = 1_000


class LivelockDetector:
    """Watches one loop of a run in virtual time.

    The next step of a state depends on userdata, on answers of the bus, on random numbers of the run and on the clock.
    Where none of these changed during many iterations of a loop, no node was entered for the first time, and no timer
    outlasts some of its iterations, the loop never ends.

    Args:
        path: The path of the looping container.
        execution: The execution of the run.
    """

    def __init__(self, path: str, execution: Execution) -> None:
        self._path = path
        self._execution = execution
        self._loop = asyncio.get_running_loop()
        self._steps = 0
        self._last = self._snapshot()
        self._since_s = self._last[0]

    def step(self) -> float | None:
        """Count a step; return the time passed without progress once the limit is reached, else None."""
        self._steps += 1
        if self._steps % _LOOK_EVERY:
            return None
        before, self._last = self._last, self._snapshot()
        if before[1:] != self._last[1:] or not self._all_wait_for_timers(since_s=before[0]):
            self._steps = 0
            self._since_s = self._last[0]
            return None
        return self._last[0] - self._since_s if self._steps >= self._execution.polling_limit else None

    def _snapshot(self) -> tuple[float, int, int]:
        """Return the time, the progress count, and the number of nodes entered so far."""
        return self._loop.time(), self._execution.progress_count, len(self._execution.visits)

    def _all_wait_for_timers(self, *, since_s: float) -> bool:
        """Return whether every active state waits for a timer that was set after the last check."""
        timers = self._execution.branch_holds.timers
        if any(timer.since_s <= since_s for timer in timers):
            return False
        active = self._execution.activity.nodes
        leaves = (path for path in active if not any(other != path and is_inside(path, other) for other in active))
        timed = {timer.path for timer in timers}
        # The loop itself may be between two of its states.
        return all(path in timed or is_inside(path, self._path) for path in leaves)

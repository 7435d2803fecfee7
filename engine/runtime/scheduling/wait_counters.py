"""Counts waits by node path, and the steps of loops that never wait."""

from __future__ import annotations

from engine.clock import Clock
from engine.node_path import is_inside

SHORTEST_S = 1e-6
"""Shorter waits do not count: this is the resolution of event times."""
_FAIRNESS = 256


class WaitCounter:
    """Counts the waits of the states of one run, by path."""

    def __init__(self) -> None:
        self.count = 0
        self._last: dict[str, int] = {}

    def add(self, path: str) -> None:
        """Count a wait of the state or tree node at `path`."""
        self.count += 1
        self._last[path] = self.count

    def add_timed(self, path: str, duration_s: float) -> None:
        """Count a wait of `duration_s`, unless it is shorter than `SHORTEST_S`."""
        if duration_s >= SHORTEST_S:
            self.add(path)

    def last(self, path: str) -> int:
        """Return the number of the last wait at or inside `path`, counted from 1; 0 where there was none."""
        return max((count for each, count in self._last.items() if is_inside(path, each)), default=0)


class BusyLoopCounter:
    """Counts the steps of one loop without a wait; waits of siblings do not count.

    Args:
        path: The path of the looping container.
        waits: The wait counter of the run.
        clock: The clock; virtual time advances only when everything waits, so there it replaces `waits`.
    """

    __slots__ = ("_clock", "_path", "_seen", "_waits", "count")

    def __init__(self, path: str, waits: WaitCounter, clock: Clock) -> None:
        self.count = 0
        self._path = path
        self._waits = waits
        self._clock = clock
        self._seen = clock.now_s() if clock.virtual else waits.count

    def step(self, *, most: int) -> bool:
        """Count a step; return whether other tasks are due a turn, or `most` steps passed without a wait."""
        self.count += 1
        if self.count % _FAIRNESS and self.count < most:
            return False
        last = self._clock.now_s() if self._clock.virtual else self._waits.last(self._path)
        if last > self._seen:
            self.count, self._seen = 0, last
        return self.count > 0

"""Timing of a blocked motion: the wait for a free path, the pauses between searches, the dwell after many stops."""

from __future__ import annotations

from engine.clock import Clock

# At rest: the period of checks without a scene change, and the first and longest pause between two searches.
_LOOK_S, _PAUSE_S, _LONGEST_PAUSE_S = 0.25, 0.2, 5.0
# After this many stops of one motion the arm dwells before it resumes, twice as long each time.
_STOPS_WITHOUT_DWELL, _DWELL_S, _LONGEST_DWELL_S = 3, 0.1, 3.0


class BlockedPathPolicy:
    """Tracks the waiting times of one motion.

    Args:
        clock: The arm's clock.
        patience_s: Longest wait in one place.
    """

    def __init__(self, clock: Clock, *, patience_s: float) -> None:
        self._clock = clock
        self._patience_s = patience_s
        self._total_s = 0.0
        self._since_s: float | None = None
        self._rest_since_s = 0.0
        self._search_at_s, self._pause_s = 0.0, _PAUSE_S

    @property
    def total_s(self) -> float:
        """Total time waited."""
        since = self._since_s
        return self._total_s + (self._clock.now_s() - since if since is not None else 0.0)

    @property
    def is_over(self) -> bool:
        """True when the patience is exhausted."""
        return self._since_s is not None and self._clock.now_s() - self._since_s >= self._patience_s

    @property
    def may_search(self) -> bool:
        """True when another search is due."""
        return self._clock.now_s() >= self._search_at_s

    @property
    def next_look_s(self) -> float:
        """Time until the next check, in seconds."""
        since = self._since_s if self._since_s is not None else self._clock.now_s()
        return max(0.001, min(_LOOK_S, since + self._patience_s - self._clock.now_s()))

    def begin(self) -> None:
        """Start to wait, unless it already waits."""
        if self._since_s is None:
            self._since_s = self._clock.now_s()

    def end(self) -> None:
        """Stop waiting."""
        self._total_s, self._since_s = self.total_s, None

    def rest(self) -> None:
        """Take note that the arm has come to rest."""
        self._rest_since_s = self._clock.now_s()

    def has_rested(self, *, stops: int) -> bool:
        """Return whether the arm dwelled long enough; the dwell grows while its path is free and blocked in turns."""
        excess = stops - _STOPS_WITHOUT_DWELL
        needed_s = min(_LONGEST_DWELL_S, _DWELL_S * 2.0**excess) if excess > 0 else 0.0
        return self._clock.now_s() - self._rest_since_s >= needed_s

    def searched(self, *, took_s: float) -> None:
        """Take a failed search: search at most half of the time, with growing pauses."""
        self._search_at_s = self._clock.now_s() + max(self._pause_s, took_s)
        self._pause_s = min(2.0 * self._pause_s, _LONGEST_PAUSE_S)

    def something_changed(self) -> None:
        """Reset the pause, as a failed search may now succeed; a pause that has begun continues."""
        self._pause_s = _PAUSE_S

"""How long an arm waits for a free way, how often it searches meanwhile, and how long it rests after many stops."""

from __future__ import annotations

from engine.clock import Clock

# At rest: how often to look again though nothing has changed, and the first and longest pause between two searches.
_LOOK_S, _PAUSE_S, _LONGEST_PAUSE_S = 0.25, 0.2, 5.0
# After so many stops of one motion the arm rests before it goes on, twice as long each time.
_FREELY, _DWELL_S, _LONGEST_DWELL_S = 3, 0.1, 3.0


class BlockedPathPolicy:
    """Keeps the times of one motion.

    Args:
        clock: The arm's.
        patience_s: The longest wait at one place.
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
        """How long it has waited so far."""
        since = self._since_s
        return self._total_s + (self._clock.now_s() - since if since is not None else 0.0)

    @property
    def is_over(self) -> bool:
        """Whether it has waited for as long as it may."""
        return self._since_s is not None and self._clock.now_s() - self._since_s >= self._patience_s

    @property
    def may_search(self) -> bool:
        """Whether it is time for another search."""
        return self._clock.now_s() >= self._search_at_s

    @property
    def next_look_s(self) -> float:
        """After which time to look again."""
        since = self._since_s if self._since_s is not None else self._clock.now_s()
        return max(0.001, min(_LOOK_S, since + self._patience_s - self._clock.now_s()))

    def begin(self) -> None:
        """Wait from now on, unless it waits already."""
        if self._since_s is None:
            self._since_s = self._clock.now_s()

    def end(self) -> None:
        """Wait no more."""
        self._total_s, self._since_s = self.total_s, None

    def rest(self) -> None:
        """The arm has come to rest."""
        self._rest_since_s = self._clock.now_s()

    def has_rested(self, *, stops: int) -> bool:
        """Whether the arm has rested enough: where its way is free and blocked in turns it rests ever longer."""
        often = stops - _FREELY
        needed_s = min(_LONGEST_DWELL_S, _DWELL_S * 2.0**often) if often > 0 else 0.0
        return self._clock.now_s() - self._rest_since_s >= needed_s

    def searched(self, *, took_s: float) -> None:
        """A search found nothing: search for no more than half of the time, and less and less."""
        self._search_at_s = self._clock.now_s() + max(self._pause_s, took_s)
        self._pause_s = min(2.0 * self._pause_s, _LONGEST_PAUSE_S)

    def something_changed(self) -> None:
        """What was in vain may not be any more; a pause that has begun is kept."""
        self._pause_s = _PAUSE_S

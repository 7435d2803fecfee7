"""Delivers recorded responses and messages, each at its recorded time and position.

Time alone does not give the order of what happened at one instant, and that order decides which
branch of a concurrency was first. So a run recorded on the virtual clock gets each answer just
when all events before it have happened again; the time only says how long to wait for that.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from engine.replay.replay_loop import ReplayLoop

BEFORE_CANCEL = -1
"""In place of a number of turns: what seems to have been asked to stop before it ended was asked after it."""
_DRIFT_S = 0.1
"""Tolerance within which a request is answered at the recorded time."""


@dataclass(eq=False)
class ScheduledDelivery:
    """A scheduled delivery: index in the recording, time, and callback."""

    place: int
    at_s: float
    deliver: Callable[[], object]
    late: bool = False
    """Whether all other events of its instant have priority while no one requests it."""


class RecordedSchedule:
    """Controls a `ReplayLoop`: advances time from one recorded response to the next.

    Args:
        loop: The loop of the replay.
        by_place: Whether the order of events is to be that of the recording.
        resolution_s: How finely the recorded times are known.
        until_s: Past this time nothing is expected any more.
        turns: By how many turns of the loop things come later within their instant, by place.
        on_standstill: Called once when nothing can happen any more, or nothing has until `until_s`.
    """

    def __init__(
        self,
        loop: ReplayLoop,
        *,
        by_place: bool,
        resolution_s: float,
        until_s: float,
        turns: Mapping[int, int],
        on_standstill: Callable[[], None],
    ) -> None:
        self._loop = loop
        self._zero_s = loop.time()
        self._by_place = by_place
        self._slack_s = resolution_s
        self._grace_s = 2 * resolution_s if by_place else _DRIFT_S
        self._until_s = until_s
        self._turns = turns
        self._on_standstill = on_standstill
        self._still = False
        self._happened = 0
        self._dues: list[ScheduledDelivery] = []

    @property
    def busy(self) -> bool:
        """Until a standstill: it is the one to notice that nothing can happen any more."""
        return not self._still

    def now_s(self) -> float:
        """Return the time of the run."""
        return self._loop.time() - self._zero_s

    def time_for(self, sent_s: float, ended_s: float) -> float:
        """Return the end time now for a request that took from `sent_s` to `ended_s` in the recording."""
        now_s = self.now_s()
        if abs(now_s - sent_s) <= _DRIFT_S:
            return max(ended_s, now_s)
        return now_s + max(0.0, ended_s - sent_s)

    def is_delayed(self, place: int) -> bool:
        """Return whether the delivery with this index is delayed by some iterations of the loop."""
        return self._turns.get(place, 0) > 0

    def expect(
        self, place: int, at_s: float, deliver: Callable[[], object], *, late: bool = False
    ) -> ScheduledDelivery:
        """Schedule a delivery at its position and time, possibly immediately; `deliver` must not record events."""
        due = ScheduledDelivery(place, at_s, deliver, late and self._turns.get(place) != BEFORE_CANCEL)
        self._dues.append(due)
        self._hand_out_if_due(due)
        return due

    def request_delivery(self, due: ScheduledDelivery) -> None:
        """Let it wait for nothing but its place and time."""
        due.late = False
        if due in self._dues:
            self._hand_out_if_due(due)

    def forget(self, due: ScheduledDelivery) -> None:
        """Cancel the delivery."""
        if due in self._dues:
            self._dues.remove(due)

    def count(self) -> None:
        """Count one more event of the recording, and make the next delivery if it is due."""
        self._happened += 1
        if self._by_place:
            following = next((due for due in self._dues if due.place == self._happened), None)
            if following is not None:
                self._hand_out_if_due(following)

    def advance(self, until_s: float) -> float:
        """Hand out the next thing if it is due by `until_s` of the loop's time, and return when it was."""
        due = self._earliest(until_s - self._zero_s)
        if due is None:
            if self._still or until_s <= self._until_s + self._zero_s:
                return until_s
            self._still = True
            self._on_standstill()
            return self._loop.time()
        at_s = max(self._loop.time(), min(until_s, due.at_s + self._zero_s))
        self._hand_out(due)
        return at_s

    def _earliest(self, until_s: float) -> ScheduledDelivery | None:
        if self._by_place:
            following = next((due for due in self._dues if self._is_next(due)), None)
            if following is not None:
                return following if following.at_s <= self._limit(following, until_s) else None
        first = min(self._dues, key=lambda due: (due.at_s, due.place), default=None)
        return first if first is not None and first.at_s <= self._limit(first, until_s) else None

    def _limit(self, due: ScheduledDelivery, until_s: float) -> float:
        """Return up to when a thing is handed out before a timer that is due at `until_s`."""
        waits = due.late or not self._is_next(due)
        return until_s + self._slack_s - (self._grace_s if waits and not math.isinf(until_s) else 0.0)

    def _is_next(self, due: ScheduledDelivery) -> bool:
        return not self._by_place or due.place == self._happened

    def _hand_out_if_due(self, due: ScheduledDelivery) -> None:
        if not due.late and self._is_next(due) and due.at_s <= self.now_s() + self._slack_s:
            self._hand_out(due)

    def _hand_out(self, due: ScheduledDelivery) -> None:
        self._dues.remove(due)
        if self.is_delayed(due.place):
            self._hand_out_after(self._turns[due.place] - 1, due)
        else:
            self._loop.run_before_ready(due.deliver)

    def _hand_out_after(self, turns: int, due: ScheduledDelivery) -> None:
        if turns:
            self._loop.call_soon(self._hand_out_after, turns - 1, due)
        else:
            due.deliver()

"""Compares the events of a replay with those of its recording, one by one as they occur."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Sequence
from typing import Protocol

from engine.event import Event, GoalSent, ServiceCalled
from engine.recording import RecordedEvent
from engine.replay.plain_event import plain_event
from engine.replay.replay_difference import CONTEXT, ReplayDifference, event_difference
from engine.replay.request_fields import with_all_fields

TIME_TOLERANCE_S = 1.5e-6
"""Times of events are rounded to a microsecond, in the recording and in the replay."""


class EventComparison(Protocol):
    """Expected events, and whether they occurred."""

    @property
    def met(self) -> int:
        """Number of equal events so far."""
        ...

    @property
    def done(self) -> bool:
        """True when every recorded event has occurred."""
        ...

    def take(self, event: Event) -> ReplayDifference | None:
        """Compare the next event of the replay."""
        ...

    def missing(self, why: str) -> ReplayDifference | None:
        """Return the first recorded event that has not occurred; None if all have."""
        ...


class TotalOrderComparison:
    """Compares every event in order and with its time; for recordings on the virtual clock."""

    def __init__(self, expected: Sequence[RecordedEvent]) -> None:
        self._expected = expected
        self._met = 0

    @property
    def met(self) -> int:
        """Number of equal events so far."""
        return self._met

    @property
    def done(self) -> bool:
        """True when every recorded event has occurred."""
        return self._met == len(self._expected)

    def take(self, event: Event) -> ReplayDifference | None:
        """Compare the next event of the replay."""
        recorded = self._expected[self._met].event if not self.done else None
        if recorded is not None and _is_same(recorded, event) and _is_same_time(recorded, event):
            self._met += 1
            return None
        return event_difference(recorded, event, before=self._before(), why=_unknown(recorded, event))

    def missing(self, why: str) -> ReplayDifference | None:
        """Return the first recorded event that has not occurred; None if all have."""
        if self.done:
            return None
        return event_difference(self._expected[self._met].event, None, before=self._before(), why=why)

    def _before(self) -> list[Event]:
        return [each.event for each in self._expected[max(0, self._met - CONTEXT) : self._met]]


class PathOrderComparison:
    """Compares the events of each path in order, without times; for recordings in real time.

    Between two branches the order of real time is chance, and so is every time.
    """

    def __init__(self, expected: Sequence[RecordedEvent]) -> None:
        self._due: dict[str, deque[Event]] = defaultdict(deque)
        self._expected = expected
        for each in expected:
            self._due[_path(each.event)].append(each.event)
        self._met = 0
        self._last: dict[str, deque[Event]] = defaultdict(lambda: deque(maxlen=CONTEXT))

    @property
    def met(self) -> int:
        """Number of equal events so far."""
        return self._met

    @property
    def done(self) -> bool:
        """True when every recorded event has occurred."""
        return self._met == len(self._expected)

    def take(self, event: Event) -> ReplayDifference | None:
        """Compare the next event of the replay."""
        path = _path(event)
        due = self._due[path]
        recorded = due[0] if due else None
        if recorded is not None and _is_same(recorded, event):
            self._last[path].append(due.popleft())
            self._met += 1
            return None
        return event_difference(recorded, event, before=tuple(self._last[path]), why=_unknown(recorded, event))

    def missing(self, why: str) -> ReplayDifference | None:
        """Return the first recorded event that has not occurred; None if all have."""
        left = [due[0] for due in self._due.values() if due]
        if not left:
            return None
        first = min(left, key=lambda event: event.seq)
        return event_difference(first, None, before=tuple(self._last[_path(first)]), why=why)


def _is_same(recorded: Event, replayed: Event) -> bool:
    if type(recorded) is not type(replayed):
        return False
    plain = plain_event(replayed)
    if plain == plain_event(recorded):
        return True
    return isinstance(recorded, (GoalSent, ServiceCalled)) and plain == plain_event(with_all_fields(recorded))


def _is_same_time(recorded: Event, replayed: Event) -> bool:
    return abs(recorded.time_s - replayed.time_s) <= TIME_TOLERANCE_S


def _unknown(recorded: Event | None, replayed: Event) -> str:
    """Return the difference text of a request that the recording does not contain."""
    if not isinstance(replayed, (GoalSent, ServiceCalled)):
        return ""
    if isinstance(recorded, (GoalSent, ServiceCalled)) and recorded.path == replayed.path:
        return ""
    return "the recording does not contain this request"


def _path(event: Event) -> str:
    return getattr(event, "path", "")

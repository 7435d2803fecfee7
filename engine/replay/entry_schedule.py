"""Entry times of nodes in a recording: the triggers for repeated checks of a tree leave no other trace."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from engine.event import NodeEntered
from engine.recording import RecordedEvent
from engine.replay.recorded_requests import RecordedInstant
from engine.replay.recorded_schedule import RecordedSchedule


class RecordedEntrySchedule:
    """The expected entries of a recording, by path and visit.

    Args:
        expected: The events to come again.
        timetable: Hands them out.
    """

    def __init__(self, expected: Sequence[RecordedEvent], timetable: RecordedSchedule) -> None:
        self._timetable = timetable
        self._instants = {
            (each.event.path, each.event.visit): RecordedInstant(place, each.at_s)
            for place, each in enumerate(expected)
            if isinstance(each.event, NodeEntered)
        }

    def expect(self, path: str, visit: int, wake: Callable[[], None]) -> Callable[[], None]:
        """Call `wake` when the node at `path` is due to be entered the `visit`-th time; returns what forgets that."""
        moment = self._instants.get((path, visit))
        if moment is None:
            return lambda: None
        due = self._timetable.expect(moment.place, moment.at_s, wake)
        return lambda: self._timetable.forget(due)

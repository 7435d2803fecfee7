"""The measured markers of one run, from the results of its goals and from its recordings; kept until either changes."""

from __future__ import annotations

import threading
from bisect import bisect_right
from collections.abc import Sequence
from pathlib import Path

from editor_web.past.goal_results import goal_markers, performed_goals
from editor_web.past.measured_marker import MeasuredMarker, MeasuredMarkers
from editor_web.past.recorded_curves import RecordedPieces
from editor_web.past.telemetry_markers import read_every, telemetry_markers
from engine.event import Event

MAX_MEASURED = 2000
"""Markers in one answer; joints at their limits are dropped first."""
STILL_ACTIVE = "telemetry is read when the run has ended"
NOT_RECORDED = "there is no recording of this run"
_Key = tuple[int, bool, tuple[tuple[str, int, int], ...]]


class MeasuredRun:
    """What was measured in one run; thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._kept: tuple[_Key, MeasuredMarkers] | None = None

    def markers(self, events: Sequence[Event], files: Sequence[Path], *, has_ended: bool) -> MeasuredMarkers:
        """Return the markers of a run, kept from before if nothing has changed.

        Args:
            events: All its events so far.
            files: Its recordings, oldest first; none if it was not recorded.
            has_ended: Whether it has; the telemetry of an active run is not read, for it grows all the time.

        Raises:
            RecordingError: a recording cannot be read.
        """
        used = tuple(files) if has_ended else ()
        seq = events[-1].seq if events else 0
        key = (seq, has_ended, tuple(_version(file) for file in used))
        with self._lock:
            if self._kept is None or self._kept[0] != key:
                self._kept = (key, _measured(events, used, seq=seq, has_ended=has_ended))
            return self._kept[1]


def _measured(events: Sequence[Event], files: Sequence[Path], *, seq: int, has_ended: bool) -> MeasuredMarkers:
    marks, every = list(goal_markers(events)), 1
    if files:
        times_s = [event.time_s for event in events]

        def seq_at(time_s: float) -> int:
            index = bisect_right(times_s, time_s)
            return events[index - 1].seq if index else 0

        with RecordedPieces(files) as pieces:
            marks += telemetry_markers(pieces, performed_goals(events), seq_at)
            every = read_every(pieces)
    shown, left_out = _limited(marks)
    unread = "" if files else NOT_RECORDED if has_ended else STILL_ACTIVE
    return MeasuredMarkers(seq=seq, marks=shown, unread=unread, every=every, left_out=left_out)


def _limited(marks: list[MeasuredMarker]) -> tuple[tuple[MeasuredMarker, ...], int]:
    """Return at most `MAX_MEASURED` markers in order of time, and how many were dropped."""
    by_weight = sorted(marks, key=lambda mark: (mark.kind == "limit", mark.time_s))[:MAX_MEASURED]
    return tuple(sorted(by_weight, key=lambda mark: (mark.time_s, mark.seq))), len(marks) - len(by_weight)


def _version(file: Path) -> tuple[str, int, int]:
    try:
        status = file.stat()
    except OSError:
        return (str(file), 0, 0)  # opening it says why
    return (str(file), status.st_size, status.st_mtime_ns)

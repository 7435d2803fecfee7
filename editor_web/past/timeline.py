"""The timeline of a run: activation intervals of each node, and markers."""

from __future__ import annotations

import math

import msgspec

from editor_web.past.intervals import MAX_INTERVALS, merge_intervals
from editor_web.past.markers import TimelineMarker, limit_markers, marker_of
from editor_web.past.state_history import RunStateHistory
from engine.archive import ActivationInterval, ActivationIntervals
from engine.event import Event


class TimelineRow(msgspec.Struct, frozen=True, kw_only=True):
    """The intervals of one node, in order; its path gives its depth."""

    path: str
    spans: tuple[ActivationInterval, ...]


class Timeline(msgspec.Struct, frozen=True, kw_only=True):
    """A run up to event `seq`, or its intervals that started or ended after the requested event.

    `merged` means that adjacent intervals were merged: request a shorter time range for the exact ones. `left_out` is
    the number of dropped markers.
    """

    run: str
    seq: int
    duration_s: float
    ended: bool
    merged: bool
    rows: tuple[TimelineRow, ...]
    marks: tuple[TimelineMarker, ...]
    left_out: int


class RunHistory:
    """A run from its first event on: state history, intervals and markers. Not thread-safe."""

    def __init__(self, run_id: str) -> None:
        self.run_id = run_id
        self.states = RunStateHistory(run_id)
        self._spans = ActivationIntervals()
        self._marks: list[TimelineMarker] = []

    def follow(self, event: Event) -> None:
        """Apply the next event; no effect if it was applied before."""
        change = self.states.follow(event)
        if change is None:
            return
        if change.nodes:
            self._spans.take(event, change.nodes)
        mark = marker_of(event)
        if mark is not None:
            self._marks.append(mark)

    def timeline(
        self, *, from_s: float = 0.0, until_s: float = math.inf, after_seq: int = 0, most: int = MAX_INTERVALS
    ) -> Timeline:
        """Return the part of the run that overlaps a time range and is newer than an event; all of it if merged."""
        now = self.states.now
        is_many = len(self._spans) > most
        after_seq = 0 if is_many else after_seq
        rows = self._spans.of(from_s=from_s, until_s=until_s, after_seq=after_seq)
        count = sum(map(len, rows.values()))
        if count > most:
            rows = merge_intervals(rows, span_s=min(until_s, now.time_s) - max(from_s, 0.0), most=most)
        marks, left_out = limit_markers(
            mark for mark in self._marks if from_s <= mark.time_s <= until_s and mark.seq > after_seq
        )
        return Timeline(
            run=self.run_id,
            seq=now.seq,
            duration_s=now.time_s,
            ended=now.ended,
            merged=is_many,
            rows=tuple(TimelineRow(path=path, spans=rows[path]) for path in sorted(rows)),
            marks=marks,
            left_out=left_out,
        )

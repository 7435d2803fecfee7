"""Activation intervals of each node, derived from the live run state, merged if there are too many."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

import msgspec

from engine.event import Event
from engine.runtime.history import NodeLive

MAX_INTERVALS = 12_000
"""Maximum number of intervals in one response; more are merged."""
_WORST = {"failed": 0, "stopped": 1, "active": 2, "done": 3}


class ActivationInterval(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One activation of a node, or `count` adjacent ones; `end_s` is null while it is active.

    `status` is active, done, failed or stopped, the worst of several; `seq` and `end_seq` are the events that started
    and ended it.
    """

    start_s: float
    end_s: float | None
    status: str
    outcome: str
    visit: int
    seq: int
    end_seq: int
    count: int


class ActivationIntervals:
    """The intervals of one run, by node path; not thread-safe."""

    def __init__(self) -> None:
        self._over: defaultdict[str, list[ActivationInterval]] = defaultdict(list)
        self._open: dict[str, ActivationInterval] = {}
        self._count = 0

    def __len__(self) -> int:
        return self._count + len(self._open)

    def take(self, event: Event, changed: Mapping[str, NodeLive]) -> None:
        """Apply the node changes of an event."""
        for path, node in changed.items():
            known = self._open.get(path)
            if node.status == "active":
                if known is not None and (known.start_s, known.visit) == (node.entered_s, node.visits):
                    # Another field of the node has changed.
                    continue
                if known is not None:
                    self._close(path, event, "stopped", "")
                self._begin(path, event, node)
            elif known is not None:
                status = node.status if node.status in _WORST else "stopped"
                self._close(path, event, status, node.outcome)

    def of(self, *, from_s: float, until_s: float, after_seq: int) -> dict[str, tuple[ActivationInterval, ...]]:
        """Return the intervals that overlap a time range and started or ended after an event, in order, by path."""
        selected: dict[str, tuple[ActivationInterval, ...]] = {}
        for path in {*self._over, *self._open}:
            spans = tuple(
                span
                for span in self._all(path)
                if max(span.seq, span.end_seq) > after_seq
                and span.start_s <= until_s
                and (span.end_s is None or span.end_s >= from_s)
            )
            if spans:
                selected[path] = spans
        return selected

    def _all(self, path: str) -> Iterator[ActivationInterval]:
        yield from self._over.get(path, ())
        if path in self._open:
            yield self._open[path]

    def _begin(self, path: str, event: Event, node: NodeLive) -> None:
        self._open[path] = ActivationInterval(
            start_s=node.entered_s,
            end_s=None,
            status="active",
            outcome="",
            visit=node.visits,
            seq=event.seq,
            end_seq=0,
            count=1,
        )

    def _close(self, path: str, event: Event, status: str, outcome: str) -> None:
        begun = self._open.pop(path)
        self._count += 1
        self._over[path].append(
            ActivationInterval(
                start_s=begun.start_s,
                end_s=event.time_s,
                status=status,
                outcome=outcome,
                visit=begun.visit,
                seq=begun.seq,
                end_seq=event.seq,
                count=1,
            )
        )


def merge_intervals(
    spans: Mapping[str, tuple[ActivationInterval, ...]], *, span_s: float, most: int = MAX_INTERVALS
) -> dict[str, tuple[ActivationInterval, ...]]:
    """Return at most `most` intervals if possible: adjacent intervals of a node are merged.

    Args:
        spans: Intervals by path, in order.
        span_s: The displayed time range; the first attempt merges intervals closer than 1/4000 of it.
        most: Maximum number of intervals left; nodes with a single interval cannot be merged further.
    """
    gap_s = span_s / 4000
    merged = dict(spans)
    while sum(map(len, merged.values())) > max(most, len(merged)) and gap_s <= 2 * span_s:
        merged = {path: tuple(_merge_row(row, gap_s)) for path, row in spans.items()}
        gap_s *= 2
    return merged


def _merge_row(row: Iterable[ActivationInterval], gap_s: float) -> Iterator[ActivationInterval]:
    held: ActivationInterval | None = None
    for span in row:
        if held is None:
            held = span
        elif held.end_s is not None and _end(span) - held.start_s <= gap_s:
            held = _join(held, span)
        else:
            yield held
            held = span
    if held is not None:
        yield held


def _end(span: ActivationInterval) -> float:
    return span.start_s if span.end_s is None else span.end_s


def _join(one: ActivationInterval, other: ActivationInterval) -> ActivationInterval:
    worst = min(one, other, key=lambda span: _WORST[span.status])
    return msgspec.structs.replace(
        one,
        end_s=other.end_s,
        status=worst.status,
        outcome=worst.outcome,
        visit=other.visit,
        end_seq=other.end_seq,
        count=one.count + other.count,
    )

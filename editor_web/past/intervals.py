"""When each node was active: spans derived from the fold of the live view, merged where there are too many."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

import msgspec

from editor_web.live.run_state import NodeLive
from engine.event import Event

MAX_INTERVALS = 12_000
"""Spans in one answer; more are merged."""
_WORST = {"failed": 0, "stopped": 1, "active": 2, "done": 3}


class ActivationInterval(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One activation of a node, or `count` of them that lie close together; `end_s` is null while it is active.

    `status` is active, done, failed or stopped, the worst one of several; `seq` and `end_seq` are the events that
    began and ended it.
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
    """The spans of one run, by the path of the node; not to be used by two threads at once."""

    def __init__(self) -> None:
        self._over: defaultdict[str, list[ActivationInterval]] = defaultdict(list)
        self._open: dict[str, ActivationInterval] = {}
        self._count = 0

    def __len__(self) -> int:
        return self._count + len(self._open)

    def take(self, event: Event, changed: Mapping[str, NodeLive]) -> None:
        """Take what an event has changed in the fold."""
        for path, node in changed.items():
            known = self._open.get(path)
            if node.status == "active":
                if known is not None and (known.start_s, known.visit) == (node.entered_s, node.visits):
                    # Something else of it has changed.
                    continue
                if known is not None:
                    self._close(path, event, "stopped", "")
                self._begin(path, event, node)
            elif known is not None:
                status = node.status if node.status in _WORST else "stopped"
                self._close(path, event, status, node.outcome)

    def of(self, *, from_s: float, until_s: float, after_seq: int) -> dict[str, tuple[ActivationInterval, ...]]:
        """Return the spans that touch a time and were begun or ended after an event, in order, by path."""
        found: dict[str, tuple[ActivationInterval, ...]] = {}
        for path in {*self._over, *self._open}:
            spans = tuple(
                span
                for span in self._all(path)
                if max(span.seq, span.end_seq) > after_seq
                and span.start_s <= until_s
                and (span.end_s is None or span.end_s >= from_s)
            )
            if spans:
                found[path] = spans
        return found

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
    """Return at most `most` spans where that can be: those of a node that lie close together become one.

    Args:
        spans: By path, in order.
        span_s: The time that is looked at; as a first try, what is nearer than a 4000th of it is merged.
        most: How many spans may be left; nodes with one each cannot be merged any further.
    """
    near_s = span_s / 4000
    made = dict(spans)
    while sum(map(len, made.values())) > max(most, len(made)) and near_s <= 2 * span_s:
        made = {path: tuple(_joined(row, near_s)) for path, row in spans.items()}
        near_s *= 2
    return made


def _joined(row: Iterable[ActivationInterval], near_s: float) -> Iterator[ActivationInterval]:
    held: ActivationInterval | None = None
    for span in row:
        if held is None:
            held = span
        elif held.end_s is not None and _end(span) - held.start_s <= near_s:
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

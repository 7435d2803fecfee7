"""Activation intervals of each node of a run, derived from the changes of its state."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

import msgspec

from engine.event import Event
from engine.runtime.history import NodeLive

_ENDS = frozenset({"failed", "stopped", "done"})


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
                status = node.status if node.status in _ENDS else "stopped"
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

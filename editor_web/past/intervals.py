"""Adjacent activation intervals merged, where there are more than a page can draw."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import msgspec

from engine.archive import ActivationInterval

MAX_INTERVALS = 12_000
"""Maximum number of intervals in one response; more are merged."""
_WORST = {"failed": 0, "stopped": 1, "active": 2, "done": 3}


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

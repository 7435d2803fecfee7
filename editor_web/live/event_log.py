"""Lines of the log of the page; `engine.runtime.history.event_texts` says what is in them."""

from __future__ import annotations

from typing import get_args

import msgspec

from engine.cause_chain import links_from_root
from engine.event import AnyEvent, Cause, Event
from engine.runtime.history import event_text

_KINDS = {kind: str(kind.__struct_config__.tag) for kind in get_args(AnyEvent)}


class CauseLine(msgspec.Struct, frozen=True, kw_only=True):
    """One link of a cause chain; the first link is the root cause."""

    message: str
    where: str
    kind: str


class LogLine(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One line of the event log; `level` is debug, info, warning or error, `kind` the event's tag."""

    seq: int
    time_s: float
    kind: str
    level: str
    path: str
    text: str
    causes: tuple[CauseLine, ...] = ()


def log_line(event: Event, *, duration_s: float | None = None) -> LogLine:
    """Return the log line of an event; `duration_s` is the duration of the node that ended."""
    said = event_text(event, duration_s=duration_s)
    return LogLine(
        seq=event.seq,
        time_s=event.time_s,
        kind=_KINDS[type(event)],
        level=said.level,
        path=said.path,
        text=said.text,
        causes=_lines(said.cause) if said.cause is not None else (),
    )


def _lines(cause: Cause | None) -> tuple[CauseLine, ...]:
    return tuple(CauseLine(message=c.message, where=c.where, kind=c.kind) for c in links_from_root(cause))

"""Lines of the log of a run; `engine.runtime.history.event_texts` says what is in them."""

from __future__ import annotations

from typing import get_args

import msgspec

from engine.cause_chain import cause_line, links_from_root
from engine.errors import CauseLine
from engine.event import AnyEvent, Event
from engine.runtime.history.event_texts import event_text

_KINDS = {kind: str(kind.__struct_config__.tag) for kind in get_args(AnyEvent)}


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
    shown = event_text(event, duration_s=duration_s)
    return LogLine(
        seq=event.seq,
        time_s=event.time_s,
        kind=_KINDS[type(event)],
        level=shown.level,
        path=shown.path,
        text=shown.text,
        causes=tuple(map(cause_line, links_from_root(shown.cause))),
    )

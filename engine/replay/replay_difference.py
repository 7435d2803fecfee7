"""The first difference between a recording and its replay, as one line and with the preceding events."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

from engine.event import Event
from engine.replay.plain_event import plain_event
from engine.replay.value_change import value_changes
from engine.runtime.history.event_texts import event_text

CONTEXT = 10
_SHOWN = 3
_LONGEST = 60
_NOTHING = "nothing"


@dataclass(frozen=True, kw_only=True)
class ReplayDifference:
    """The first difference of a replay.

    `number` is that of the recorded event, or of the replayed one where the recording has none.
    """

    number: int
    time_s: float
    path: str
    recorded: str
    replayed: str
    detail: str = ""
    before: tuple[str, ...] = ()
    """The preceding recorded events, oldest first."""

    def __str__(self) -> str:
        place = f", {self.path}" if self.path else ""
        detail = f" ({self.detail})" if self.detail else ""
        head = f"event {self.number} at {self.time_s:.3f} s{place}"
        return f"{head}: recorded {self.recorded}; replayed {self.replayed}{detail}"

    def explained(self) -> str:
        """Return the line, followed by the preceding events."""
        return "\n".join([str(self), "after", *(f"  {line}" for line in self.before)]) if self.before else str(self)


def event_difference(
    recorded: Event | None, replayed: Event | None, *, before: Sequence[Event] = (), why: str = ""
) -> ReplayDifference:
    """Return the difference between two events, or between one and none."""
    known = recorded or replayed
    if known is None:
        raise ValueError("a difference needs an event")
    path = _path(known)
    return ReplayDifference(
        number=known.seq,
        time_s=known.time_s,
        path=path,
        recorded=_quoted(recorded, path),
        replayed=_quoted(replayed, path),
        detail=why or _detail(recorded, replayed),
        before=tuple(
            f"{event.seq} {event.time_s:.3f} s {_path(event)} {event_text(event).text}" for event in before[-CONTEXT:]
        ),
    )


def _quoted(event: Event | None, path: str) -> str:
    if event is None:
        return _NOTHING
    elsewhere = _path(event)
    text = event_text(event).text
    return f"`{text}`" if elsewhere == path else f"`{text}` of {elsewhere or 'the run'}"


def _detail(recorded: Event | None, replayed: Event | None) -> str:
    """Return the differing values of two events of one kind and node."""
    if recorded is None or replayed is None or type(recorded) is not type(replayed):
        return ""
    if _path(recorded) != _path(replayed):
        return ""
    found = value_changes(plain_event(recorded), plain_event(replayed), longest=_LONGEST)
    shown = ", ".join(
        f"{change.at}: {change.left or _NOTHING} ≠ {change.right or _NOTHING}" for change in islice(found, _SHOWN)
    )
    return shown or f"at {replayed.time_s:.6f} s instead of {recorded.time_s:.6f} s"


def _path(event: Event) -> str:
    return getattr(event, "path", "")

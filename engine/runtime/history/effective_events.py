"""The events that apply after resumes: a resumed run may have restarted before its last events."""

from __future__ import annotations

from collections.abc import Iterable

from engine.event import Event, RunResumed


def effective_events(events: Iterable[Event]) -> list[Event]:
    """Return the events that apply, without those that a resume has taken back."""
    kept: list[Event] = []
    for event in events:
        if isinstance(event, RunResumed):
            while kept and kept[-1].seq > event.after_seq:
                kept.pop()
        kept.append(event)
    return kept

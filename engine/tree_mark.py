"""Marks: what the events of a run tell of the parts of its trees. Reading a log takes them without loading py_trees."""

from __future__ import annotations

from typing import NamedTuple

from engine.event import Diverted, Entered, Event, Exited, Retried, StatusChanged, UserdataWritten


class Mark(NamedTuple):
    """One thing that happened to a part: its path, what, and the run's time.

    `what` is a status, `entered`, `failed`, `outcome NAME`, `target NAME`, `attempt NUMBER` or `assigned WHEN`.
    """

    path: str
    what: str
    at_s: float


def mark_of(event: Event) -> Mark | None:
    """Return what an event tells of a part of a tree, None for events that tell nothing."""
    match event:
        case StatusChanged():
            return Mark(event.path, event.status, event.time_s)
        case Entered():
            return Mark(event.path, "entered", event.time_s)
        case Exited():
            what = "invalid" if event.preempted else f"outcome {event.outcome}" if event.outcome else "failed"
            return Mark(event.path, what, event.time_s)
        case Diverted():
            # An operator names an outcome; timeout, guard and on_error name a status.
            said = "outcome" if event.by in ("operator", "start") else "target"
            return Mark(event.path, f"{said} {event.target}", event.time_s)
        case Retried():
            return Mark(event.path, f"attempt {event.attempt}", event.time_s)
        case UserdataWritten() if event.post:
            return Mark(event.path, f"assigned {event.post}", event.time_s)
        case _:
            return None

"""Events of behavior tree nodes, extracted from the events of a run without importing py_trees."""

from __future__ import annotations

from typing import NamedTuple

from engine.event import Event, NodeDiverted, NodeEntered, NodeExited, NodeRetried, StatusChanged, UserdataWritten


class TreeEvent(NamedTuple):
    """One event of a tree node: its path, what happened, and the time of the run.

    `what` is a status, `entered`, `failed`, `outcome NAME`, `target NAME`, `attempt NUMBER` or `assigned WHEN`.
    """

    path: str
    what: str
    at_s: float


def tree_event_of(event: Event) -> TreeEvent | None:
    """Return the tree event of an event; None for events that concern no tree node."""
    match event:
        case StatusChanged():
            return TreeEvent(event.path, event.status, event.time_s)
        case NodeEntered():
            return TreeEvent(event.path, "entered", event.time_s)
        case NodeExited():
            what = "invalid" if event.preempted else f"outcome {event.outcome}" if event.outcome else "failed"
            return TreeEvent(event.path, what, event.time_s)
        case NodeDiverted():
            # An operator names an outcome; timeout, guard and on_error name a status.
            kind = "outcome" if event.by in ("operator", "start") else "target"
            return TreeEvent(event.path, f"{kind} {event.target}", event.time_s)
        case NodeRetried():
            return TreeEvent(event.path, f"attempt {event.attempt}", event.time_s)
        case UserdataWritten() if event.post:
            return TreeEvent(event.path, f"assigned {event.post}", event.time_s)
        case _:
            return None

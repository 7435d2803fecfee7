"""State of the nodes of one tree activation, derived from the events of a run, to resume the tree.

`fold_tree_events` folds the events of an activation, in order, into the state of each node. This is sufficient: the
internal state of py_trees composites follows from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from engine.runtime.record.tree_event import TreeEvent

_OVER = ("success", "failure", "skipped", "invalid")
_STATUSES = ("running", "success", "failure", "skipped")


@dataclass
class TreeNodeState:
    """State of one node after its events; events are numbered from 0."""

    status: str = "invalid"
    since_s: float = 0.0
    order: int = -1
    """The last event of this node."""
    active: int = -1
    """The last event by which it was active."""
    skipped: int = -1
    """The last event by which it was skipped."""
    over: int = -1
    """The last event by which it was not RUNNING: older events belong to an earlier activation."""
    opened: int = -1
    """The event by which it last became RUNNING."""
    passed: int = -1
    """For an ended leaf: the event of a tick that did not reach it; -1 where there is none, or it was read."""
    ended_s: float | None = None
    """When it last stopped being RUNNING; None where it never was RUNNING."""
    final: str | None = None
    """The status that a one-shot keeps: success overrides an earlier failure."""
    first: str | None = None
    """The first final status."""
    assigned: dict[str, int] = field(default_factory=dict[str, int])
    """Number of post-condition assignments since its last other event, by `on_success` and so on."""
    attempt: int = 1
    rounds: int = 0
    """Number of further rounds begun in this activation."""
    outcome: str | None = None
    target: str | None = None
    read: bool = True
    """For an ended leaf: whether later events show that a tick has read its end."""


def decode_tree_events(kept: Iterable[tuple[object, ...]]) -> Iterator[TreeEvent]:
    """Yield the events that were stored as plain tuples; invalid ones are ignored."""
    for each in kept:
        match each:
            case (str(path), str(what), float() | int() as at_s):
                yield TreeEvent(path, what, at_s)
            case _:
                pass


def fold_tree_events(events: Iterable[TreeEvent]) -> dict[str, TreeNodeState]:
    """Return the state of each node after these events."""
    states: dict[str, TreeNodeState] = {}
    unread: list[TreeNodeState] = []
    for number, event in enumerate(events):
        state = states.setdefault(event.path, TreeNodeState())
        if event.what.startswith("assigned "):
            when = event.what.partition(" ")[2]
            state.assigned[when] = state.assigned.get(when, 0) + 1
            continue
        if state.status == "ended" and event.what in _STATUSES:
            state.passed = number if event.what == "running" else -1
            _read(unread)
            continue
        state.assigned.clear()
        state.order, state.passed = number, -1
        what, _, name = event.what.partition(" ")
        ended = what in ("outcome", "target", "failed")
        state.over = number if ended or event.what in _OVER else state.over
        state.active = number if what in ("entered", "running", "attempt") else state.active
        state.skipped = number if event.what in ("skipped", "target skipped") else state.skipped
        own_retry = what == "attempt" and any(other is state for other in unread)
        if not ended and not own_retry:
            _read(unread)
        if ended:
            state.read = False
            unread.append(state)
        was_running = state.status == "running"
        _fold(state, what, name, event.at_s)
        state.opened = number if state.status == "running" and not was_running else state.opened
    return states


def _read(unread: list[TreeNodeState]) -> None:
    for state in unread:
        state.read = True
    unread.clear()


def _fold(state: TreeNodeState, what: str, name: str, at_s: float) -> None:
    before = state.status
    match what:
        case "attempt":
            # The retry of a node runs it again; a retry decorator is RUNNING in any case.
            state.attempt = int(name)
            state.status = "running"
            state.read = True
        case "outcome" | "target" | "failed":
            state.status = "ended"
            state.outcome = name if what == "outcome" else None
            state.target = name if what == "target" else None
        case "entered":
            state.status = "running"
        case _:
            state.rounds = state.rounds + 1 if what == before == "running" else 0
            state.attempt = state.attempt if what == "running" else 1
            state.status = what
    if what in ("success", "failure"):
        state.first = state.first or what
        state.final = what if state.final != "success" else "success"
    if before == "running" and state.status != "running":
        state.ended_s = at_s
    if state.status != before or what == "attempt":
        state.since_s = at_s

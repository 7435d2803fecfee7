"""What the events of a run tell of one activation of a tree, so that another can go on from there.

`fold_tree_events` folds the marks of an activation, in order, into how each part stood. That is enough: composites
of py_trees keep nothing that does not follow from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from engine.runtime.record.tree_event import TreeEvent

_OVER = ("success", "failure", "skipped", "invalid")
_STATUSES = ("running", "success", "failure", "skipped")


@dataclass
class TreeNodeState:
    """How one part stood at the end of its marks."""

    status: str = "invalid"
    since_s: float = 0.0
    order: int = -1
    """Which of the marks was the last one of this part."""
    began: int = -1
    """Which was the last one by which it was at work."""
    skipped: int = -1
    """Which was the last one by which it was skipped."""
    over: int = -1
    """Which was the last one by which it was not RUNNING: what is older belongs to an earlier activation."""
    opened: int = -1
    """Which was the one by which it became RUNNING last."""
    passed: int = -1
    """For a leaf that has ended: the one by which a tick had not come to it; -1 where none tells so, or it was read."""
    ended_s: float | None = None
    """When it was last RUNNING no more; None where it never was."""
    final: str | None = None
    """The first status that a one-shot keeps: success wins over an earlier failure."""
    first: str | None = None
    """The first final status at all."""
    assigned: dict[str, int] = field(default_factory=dict[str, int])
    """Assignments of post-conditions since anything else happened to it, by `on_success` and so on."""
    attempt: int = 1
    rounds: int = 0
    """How often it has begun a further round in this activation."""
    outcome: str | None = None
    target: str | None = None
    read: bool = True
    """For a leaf that has ended: whether anything followed, so that a tick has read its end."""


def decode_tree_events(kept: Iterable[tuple[object, ...]]) -> Iterator[TreeEvent]:
    """Go through marks that were kept as plain tuples; what is none is passed over."""
    for each in kept:
        match each:
            case (str(path), str(what), float() | int() as at_s):
                yield TreeEvent(path, what, at_s)
            case _:
                pass


def fold_tree_events(marks: Iterable[TreeEvent]) -> dict[str, TreeNodeState]:
    """Return how each part stood after these marks."""
    found: dict[str, TreeNodeState] = {}
    unread: list[TreeNodeState] = []
    for number, mark in enumerate(marks):
        standing = found.setdefault(mark.path, TreeNodeState())
        if mark.what.startswith("assigned "):
            when = mark.what.partition(" ")[2]
            standing.assigned[when] = standing.assigned.get(when, 0) + 1
            continue
        if standing.status == "ended" and mark.what in _STATUSES:
            standing.passed = number if mark.what == "running" else -1
            _read(unread)
            continue
        standing.assigned.clear()
        standing.order, standing.passed = number, -1
        what, _, name = mark.what.partition(" ")
        ended = what in ("outcome", "target", "failed")
        standing.over = number if ended or mark.what in _OVER else standing.over
        standing.began = number if what in ("entered", "running", "attempt") else standing.began
        standing.skipped = number if mark.what in ("skipped", "target skipped") else standing.skipped
        own_retry = what == "attempt" and any(other is standing for other in unread)
        if not ended and not own_retry:
            _read(unread)
        if ended:
            standing.read = False
            unread.append(standing)
        was_running = standing.status == "running"
        _fold(standing, what, name, mark.at_s)
        standing.opened = number if standing.status == "running" and not was_running else standing.opened
    return found


def _read(unread: list[TreeNodeState]) -> None:
    for standing in unread:
        standing.read = True
    unread.clear()


def _fold(standing: TreeNodeState, what: str, name: str, at_s: float) -> None:
    before = standing.status
    match what:
        case "attempt":
            # A node's own retry runs it again; a retry that is a decorator is RUNNING anyway.
            standing.attempt = int(name)
            standing.status = "running"
            standing.read = True
        case "outcome" | "target" | "failed":
            standing.status = "ended"
            standing.outcome = name if what == "outcome" else None
            standing.target = name if what == "target" else None
        case "entered":
            standing.status = "running"
        case _:
            standing.rounds = standing.rounds + 1 if what == before == "running" else 0
            standing.attempt = standing.attempt if what == "running" else 1
            standing.status = what
    if what in ("success", "failure"):
        standing.first = standing.first or what
        standing.final = what if standing.final != "success" else "success"
    if before == "running" and standing.status != "running":
        standing.ended_s = at_s
    if standing.status != before or what == "attempt":
        standing.since_s = at_s

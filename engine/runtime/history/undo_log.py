"""Undo log of a run: activations, transitions and writes that have not been undone, rebuilt from its events.

`engine.runtime.history.step_back` plans step backs from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import msgspec

from engine.event import (
    BehaviorChanged,
    Event,
    GoalFinished,
    GoalSent,
    NodeEntered,
    NodeExited,
    RunSteppedBack,
    ServiceAnswered,
    ServiceCalled,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
    UserdataAppended,
    UserdataWritten,
)
from engine.node_path import is_inside
from engine.runtime.history.run_state_part import RunStatePart
from engine.runtime.record.leaf_activation import LeafActivation
from engine.state import RequestRecord

_LEAVES = ("state", "substitute")
"""The kinds of nodes without children, as named in events."""


@dataclass(frozen=True)
class _Write:
    seq: int
    path: str
    scope: str
    key: str


class UndoLog(RunStatePart):
    """Built from the effective events in order: `engine.runtime.history.effective_events`."""

    def __init__(self) -> None:
        self.seq = 0
        self._done: dict[tuple[str, int], LeafActivation] = {}
        self._last: dict[str, LeafActivation] = {}
        self._entered: dict[str, int] = {}
        self._transitions: dict[str, list[TransitionTaken]] = {}
        self._writes: list[_Write] = []
        self._stepping_back: set[str] = set()

    def read(self, events: Iterable[Event]) -> UndoLog:
        """Take events; returns itself."""
        for event in events:
            self.take(event)
        return self

    def take(self, event: Event) -> None:
        """Take the next event; an event that was already taken is ignored."""
        if event.seq <= self.seq:
            return
        self.seq = event.seq
        super().take(event)

    def node_exited(self, event: NodeExited) -> None:
        """Keep the outcome of a state."""
        if (activation := self._done.get((event.path, event.visit))) is not None and not event.preempted:
            activation.outcome = event.outcome

    def transition_taken(self, event: TransitionTaken) -> None:
        """Keep the transition."""
        self._transitions.setdefault(event.path, []).append(event)

    def goal_finished(self, event: GoalFinished) -> None:
        """Keep how a goal ended."""
        self._end(event.path, event.goal, event.status, event.result)

    def call_answered(self, event: ServiceAnswered) -> None:
        """Keep how a call ended."""
        self._end(event.path, event.call, "answered" if event.cause is None else "failed", event.result)

    def undo_started(self, event: UndoStarted) -> None:
        """Keep its requests apart from those of the activation."""
        self._stepping_back.add(event.path)

    def undo_ended(self, event: UndoEnded) -> None:
        """Forget an activation that is undone."""
        self._stepping_back.discard(event.path)
        if event.cause is None and not event.preempted:
            self._done.pop((event.path, event.undoes), None)

    def behavior_changed(self, event: BehaviorChanged) -> None:
        """Mark the activations of states whose class was replaced."""
        for activation in self._done.values():
            activation.replaced = activation.replaced or activation.path in event.replaced

    def since(self, path: str) -> int:
        """Return the event with which the run reached a node: a transition, or the entry of its container."""
        container = path.rpartition("/")[0]
        before = self._transitions.get(container)
        return before[-1].seq if before else self._entered.get(container, 0)

    def done(self, path: str, since: int | None = None) -> tuple[LeafActivation, ...]:
        """Return the state activations in a node, or of the node itself, newest first.

        Args:
            path: The node.
            since: The event after which they started; by default the one with which the run reached the node.
        """
        first = self.since(path) if since is None else since
        activations = [each for each in self._done.values() if each.seq > first and is_inside(path, each.path)]
        return tuple(sorted(activations, key=lambda each: -each.seq))

    def rounds(self, path: str) -> int:
        """Return the number of transitions of a container since its entry."""
        return len(self._transitions.get(path, ()))

    def previous(self, machine: str) -> tuple[str, int] | None:
        """Return the child that a machine exited last, and the event with which it reached it; None for none."""
        before = self._transitions.get(machine)
        if not before:
            return None
        since = before[-2].seq if len(before) > 1 else self._entered.get(machine, 0)
        return before[-1].source, since

    def written_by(self, paths: Iterable[str], since: int) -> Iterator[tuple[str, str, str]]:
        """Yield the keys that nodes inside `paths` have written to scopes outside them after an event.

        Yields the scope, the key, and the path of a later writer; empty where there is none.
        """
        own = tuple(paths)
        later: dict[tuple[str, str], str] = {}
        for each in self._writes:
            if each.seq <= since or any(_is_scope_of(path, each.scope) for path in own):
                continue
            target = (each.scope, each.key)
            if any(is_inside(path, each.path) for path in own):
                later[target] = ""
            elif target in later:
                later[target] = each.path
        for (scope, key), writer in later.items():
            yield scope, key, writer

    def node_entered(self, event: NodeEntered) -> None:
        """Begin an activation."""
        if event.kind in _LEAVES:
            activation = LeafActivation(path=event.path, visit=event.visit, seq=event.seq, shown=event.inputs)
            self._done[event.path, event.visit] = self._last[event.path] = activation
        else:
            self._entered[event.path] = event.seq
            self._transitions.pop(event.path, None)

    def value_written(self, event: UserdataWritten | UserdataAppended) -> None:
        """Keep what was written where."""
        self._writes.append(_Write(event.seq, event.path, event.scope, event.key))
        if (activation := self._last.get(event.path)) is not None and isinstance(event, UserdataWritten):
            activation.written[event.key] = event.value

    def request_sent(self, event: GoalSent | ServiceCalled, name: str) -> None:
        """Keep a request of the activation."""
        activation = self._last.get(event.path)
        if activation is not None and event.path not in self._stepping_back:
            activation.requests[name] = RequestRecord(address=event.address, request=event.request)

    def _end(self, path: str, name: str, status: str, result: object) -> None:
        activation = self._last.get(path)
        if activation is not None and (sent := activation.requests.get(name)) is not None:
            activation.requests[name] = msgspec.structs.replace(sent, status=status, result=result)

    def run_stepped_back(self, event: RunSteppedBack) -> None:
        """Forget what was undone."""
        if event.cause is not None:
            return
        container = event.path.rpartition("/")[0]
        if event.source != event.path and self._transitions.get(container):
            self._transitions[container].pop()
        since = self.since(event.path)
        undone_paths = (event.path, event.source)
        for key in [key for key, each in self._done.items() if each.seq > since and _in_any(undone_paths, each.path)]:
            del self._done[key]
        self._writes = [each for each in self._writes if each.seq <= since or not _in_any(undone_paths, each.path)]


def _in_any(outer: Iterable[str], path: str) -> bool:
    return any(is_inside(each, path) for each in outer)


def _is_scope_of(path: str, scope: str) -> bool:
    """Return whether a scope belongs to a node or to a node inside it: it ends with the node."""
    return scope == path or scope.startswith((f"{path}/", f"{path}#"))

"""Undo log of a run: activations, transitions and writes that have not been undone, rebuilt from its events.

`engine.runtime.history.step_back` plans step backs from it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

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
from engine.state import ActivationRecord, RequestRecord

_LEAVES = ("state", "substitute")
"""The kinds of nodes without children, as named in events."""


@dataclass(kw_only=True)
class LeafActivation:
    """One activation of a state: its entry event, inputs, requests and outputs."""

    path: str
    visit: int
    seq: int
    shown: dict[str, object]
    """Parameters and inputs, as plain data."""
    outcome: str = ""
    requests: dict[str, RequestRecord] = field(default_factory=dict[str, RequestRecord])
    """By the name of the goal or call."""
    replaced: bool = False
    """Whether a hot change has replaced its class since."""
    written: dict[str, object] = field(default_factory=dict[str, object])
    """The values it wrote last, by the key of its container."""

    def record(self, *, inputs: Iterable[str], outputs: Mapping[str, str]) -> ActivationRecord:
        """Return the activation as its state class expects it.

        Args:
            inputs: The input keys of the class.
            outputs: The container keys that its output keys are written to.
        """
        own = {target: key for key, target in outputs.items()}
        return ActivationRecord(
            inputs={key: self.shown[key] for key in inputs if key in self.shown},
            outcome=self.outcome,
            outputs={own.get(key, key): value for key, value in self.written.items()},
            requests=tuple(self.requests.values()),
        )


@dataclass(frozen=True)
class _Write:
    seq: int
    path: str
    scope: str
    key: str


class UndoLog:
    """Built from the effective events in order: `engine.runtime.history.resume.effective_events`."""

    def __init__(self) -> None:
        self.seq = 0
        self._done: dict[tuple[str, int], LeafActivation] = {}
        self._last: dict[str, LeafActivation] = {}
        self._entered: dict[str, int] = {}
        self._transitions: dict[str, list[TransitionTaken]] = {}
        self._writes: list[_Write] = []
        self._undoing: set[str] = set()

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
        match event:
            case NodeEntered():
                self._enter(event)
            case NodeExited():
                if (activation := self._done.get((event.path, event.visit))) is not None and not event.preempted:
                    activation.outcome = event.outcome
            case TransitionTaken():
                self._transitions.setdefault(event.path, []).append(event)
            case UserdataWritten() | UserdataAppended():
                self._write(event)
            case GoalSent(goal=name) | ServiceCalled(call=name):
                self._send(event, name)
            case GoalFinished():
                self._end(event.path, event.goal, event.status, event.result)
            case ServiceAnswered():
                self._end(event.path, event.call, "answered" if event.cause is None else "failed", event.result)
            case UndoStarted():
                self._undoing.add(event.path)
            case UndoEnded():
                self._undoing.discard(event.path)
                if event.cause is None and not event.preempted:
                    self._done.pop((event.path, event.undoes), None)
            case BehaviorChanged():
                for activation in self._done.values():
                    activation.replaced = activation.replaced or activation.path in event.replaced
            case RunSteppedBack() if event.cause is None:
                self._step_back(event)
            case _:
                pass

    def since(self, path: str) -> int:
        """Return the event with which the run reached a node: a transition, or the entry of its container."""
        container = path.rpartition("/")[0]
        before = self._transitions.get(container)
        return before[-1].seq if before else self._entered.get(container, 0)

    def done(self, path: str, since: int | None = None) -> tuple[LeafActivation, ...]:
        """Return the state activations in a node, or of the node itself, newest first.

        Args:
            path: The node.
            since: The event after which they began; by default the one with which the run reached the node.
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

    def _enter(self, event: NodeEntered) -> None:
        if event.kind in _LEAVES:
            activation = LeafActivation(path=event.path, visit=event.visit, seq=event.seq, shown=event.inputs)
            self._done[event.path, event.visit] = self._last[event.path] = activation
        else:
            self._entered[event.path] = event.seq
            self._transitions.pop(event.path, None)

    def _write(self, event: UserdataWritten | UserdataAppended) -> None:
        self._writes.append(_Write(event.seq, event.path, event.scope, event.key))
        if (activation := self._last.get(event.path)) is not None and isinstance(event, UserdataWritten):
            activation.written[event.key] = event.value

    def _send(self, event: GoalSent | ServiceCalled, name: str) -> None:
        activation = self._last.get(event.path)
        if activation is not None and event.path not in self._undoing:
            activation.requests[name] = RequestRecord(address=event.address, request=event.request)

    def _end(self, path: str, name: str, status: str, result: object) -> None:
        activation = self._last.get(path)
        if activation is not None and (sent := activation.requests.get(name)) is not None:
            activation.requests[name] = msgspec.structs.replace(sent, status=status, result=result)

    def _step_back(self, event: RunSteppedBack) -> None:
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

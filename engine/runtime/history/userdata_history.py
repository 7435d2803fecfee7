"""Userdata of a run, rebuilt from its events: every scope with its values, their last writers and times.

Unlike `ResumableState`, which restores a run, it applies a write at once and keeps the values of exited containers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import msgspec

from engine.document.nodes.node_spec import FOREACH_OUTCOMES
from engine.event import (
    Event,
    NodeEntered,
    NodeExited,
    RunEnded,
    RunStarted,
    RunSteppedBack,
    StatusChanged,
    TransitionTaken,
    UserdataAppended,
    UserdataWritten,
)
from engine.node_path import is_inside
from engine.runtime.history.run_state_part import RunStatePart
from engine.runtime.nodes.behavior_reference import BehaviorReference
from engine.runtime.nodes.foreach import ForEach
from engine.runtime.plan import Plan
from engine.runtime.userdata.append_only_lists import AppendOnlyLists


class UserdataRecord(msgspec.Struct, frozen=True, kw_only=True):
    """One value: its last writer (a node path), the time on the clock of the run, and the number of writes.

    `by` is empty for an initial value of the scope.
    """

    value: object
    by: str
    at_s: float
    writes: int


class ScopeView(msgspec.Struct, frozen=True, kw_only=True):
    """The values of one container, kept after its exit; `is_open` is False then."""

    is_open: bool
    since_s: float
    values: dict[str, UserdataRecord]


class UserdataHistory(RunStatePart):
    """The scopes of one run by the path of their container, up to the last event taken.

    The scope of the behavior has the empty path, a round of a loop `path#n`, an unmerged branch of a concurrency
    container `path*`.

    Args:
        plan: Returns the current plan of the run; a hot change replaces it.
    """

    def __init__(self, plan: Callable[[], Plan]) -> None:
        self.seq = 0
        self.scopes: dict[str, ScopeView] = {}
        self._plan = plan
        self._changed: set[str] = set()
        self._items: dict[str, tuple[int, Sequence[object]]] = {}
        self._parameters: dict[str, object] = {}
        self._lists = AppendOnlyLists()
        self._begin("", plan().userdata, 0.0)

    def read(self, events: Iterable[Event]) -> None:
        """Take the next events, in order."""
        for event in events:
            self.take(event)
            self.seq = event.seq
        self._lists.give_away()

    def copy(self) -> UserdataHistory:
        """Return an independent copy."""
        copied = UserdataHistory(self._plan)
        copied.seq, copied.scopes, copied._changed, copied._items, copied._parameters = (
            self.seq,
            dict(self.scopes),
            set(self._changed),
            dict(self._items),
            self._parameters,
        )
        return copied

    def changes(self) -> dict[str, ScopeView | None]:
        """Return the scopes that have changed since the last call; None for one that no longer exists."""
        changed, self._changed = self._changed, set()
        return {path: self.scopes.get(path) for path in sorted(changed)}

    def values_at(self, path: str) -> dict[str, object]:
        """Return what a node reads by its names; inside a container also the container's own values.

        Args:
            path: The node; empty for all of the run, where the innermost container that is active counts.
        """
        declared = self._plan().parameters.items()
        read = {name: each.normal(each.default) for name, each in declared if not each.required} | self._parameters
        for container, scope in sorted(self._scopes_around(path), key=lambda each: (each[1].is_open, each[0])):
            node = self._plan().nodes.get(container)
            if path and node is not None and isinstance(node.work, BehaviorReference):
                read = {}  # what is outside of a behavior that is referred to is not read in it
            read |= {key: record.value for key, record in scope.values.items()}
        return read

    def _scopes_around(self, path: str) -> Iterator[tuple[str, ScopeView]]:
        for key, scope in self.scopes.items():
            container = key.partition("#")[0].removesuffix("*")
            if not path or not container or is_inside(container, path):
                yield container, scope

    def run_started(self, event: RunStarted) -> None:
        """Take over the parameters and inputs."""
        self._parameters = event.parameters
        for key, value in event.inputs.items():
            self._put("", key, UserdataRecord(value=value, by="", at_s=event.time_s, writes=0))

    def node_exited(self, event: NodeExited) -> None:
        """Close the scopes of a node."""
        self._close(event.path)

    def status_changed(self, event: StatusChanged) -> None:
        """Close the scopes of a tree node that ended."""
        if event.status != "running":
            self._close(event.path)

    def run_ended(self, event: RunEnded) -> None:
        """Close all scopes."""
        self._close("")

    def node_entered(self, event: NodeEntered) -> None:
        """Open the scope of a container."""
        node = self._plan().nodes.get(event.path)
        if node is None or not node.work.children:
            return
        self._forget_inside(event.path)
        if isinstance(node.work, ForEach):
            self._items[event.path] = (0, node.work.items_of(event.inputs))
            self._begin_round(event.path, node.work, event.time_s)
        else:
            self._begin(event.path, node.work.initial_values(event.inputs), event.time_s)

    def transition_taken(self, event: TransitionTaken) -> None:
        """Open the scope of the next round of a loop."""
        node = self._plan().nodes.get(event.path)
        if node is None or not isinstance(node.work, ForEach) or event.path not in self._items:
            return
        if event.target not in FOREACH_OUTCOMES:
            number, items = self._items[event.path]
            self._drop(f"{event.path}#{number}")
            self._items[event.path] = (number + 1, items)
            self._begin_round(event.path, node.work, event.time_s)

    def _begin_round(self, path: str, work: ForEach, time_s: float) -> None:
        number, items = self._items[path]
        if number < len(items):
            self._begin(f"{path}#{number}", work.round_values(number, items[number]), time_s)

    def _begin(self, path: str, values: Mapping[str, object], time_s: float) -> None:
        entries = {key: UserdataRecord(value=value, by="", at_s=time_s, writes=0) for key, value in values.items()}
        self._set(path, ScopeView(is_open=True, since_s=time_s, values=entries))

    def value_written(self, event: UserdataWritten | UserdataAppended) -> None:
        """Put the value, with its writer."""
        known = self.scopes.get(event.scope)
        before = known.values.get(event.key) if known is not None else None
        writes = 1 + (before.writes if before is not None else 0)
        if known is None:
            self._begin(event.scope, {}, event.time_s)
        value = self._lists.value_after(event, before.value if before is not None else None)
        self._put(event.scope, event.key, UserdataRecord(value=value, by=event.path, at_s=event.time_s, writes=writes))

    def run_stepped_back(self, event: RunSteppedBack) -> None:
        """Restore the values."""
        if event.cause is not None:
            return
        for path in (event.path, event.source):
            self._drop(path)
            self._forget_inside(path)
        for each in event.values:
            known = self.scopes.get(each.scope)
            if known is None:
                continue
            if each.defined:
                before = known.values.get(each.key)
                writes = 1 + (before.writes if before is not None else 0)
                entry = UserdataRecord(value=each.value, by=event.path, at_s=event.time_s, writes=writes)
                self._put(each.scope, each.key, entry)
            else:
                values = {key: entry for key, entry in known.values.items() if key != each.key}
                self._set(each.scope, msgspec.structs.replace(known, values=values))

    def _put(self, scope: str, key: str, entry: UserdataRecord) -> None:
        known = self.scopes[scope]
        self._set(scope, msgspec.structs.replace(known, values={**known.values, key: entry}))

    def _set(self, path: str, scope: ScopeView) -> None:
        self.scopes[path] = scope
        self._changed.add(path)

    def _drop(self, path: str) -> None:
        if self.scopes.pop(path, None) is not None:
            self._changed.add(path)

    def _close(self, path: str) -> None:
        for key, scope in self.scopes.items():
            if scope.is_open and (key == path or _is_inside(key, path)):
                self._set(key, msgspec.structs.replace(scope, is_open=False))

    def _forget_inside(self, path: str) -> None:
        """Drop the scopes inside a container that starts again."""
        for key in [key for key in self.scopes if _is_inside(key, path)]:
            self._drop(key)


def _is_inside(key: str, path: str) -> bool:
    return path == "" or key.startswith((f"{path}/", f"{path}#")) or key == f"{path}*"

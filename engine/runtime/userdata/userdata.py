"""Userdata: values that the states of one container share, in scopes nested like the containers.

A read searches from the innermost scope outward. A write goes to the nearest scope that has the key, else it creates
the key in the innermost scope. A branch of a concurrency container writes into its own scope, which is merged in
document order when the container finishes; shared keys are written directly to the enclosing scope that owns them. A
behavior reference isolates its scope: only the keys in `in` and `out` cross it.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sized
from typing import cast

from engine.document.expression.step_meter import METER
from engine.errors import UserdataError
from engine.runtime.userdata.append_only_lists import AppendOnlyLists
from engine.runtime.userdata.userdata_value import is_immutable
from engine.wording.suggestions import did_you_mean

_MISSING = object()
_COPY = 1.5
"""Steps per copied list, mapping or other object."""
_COPY_ITEM = 0.3


class Scope:
    """The values of one container while it is active.

    Args:
        path: The path of the container; the path of a branch ends with `*`.
        values: The initial values.
        parent: The enclosing scope.
        isolated: Whether it keeps writes from inside, as for a branch.
        shared: The keys that an isolated scope passes on to its parent.
    """

    __slots__ = ("__weakref__", "_append_only", "_isolated", "_shared", "_values", "parent", "path")

    def __init__(
        self,
        path: str,
        values: Mapping[str, object],
        parent: Scope | None = None,
        *,
        isolated: bool = False,
        shared: frozenset[str] = frozenset(),
    ) -> None:
        self.path = path
        self.parent = parent
        self._values = dict(values)
        self._isolated = isolated
        self._shared = shared
        self._append_only: AppendOnlyLists | None = None

    def read(self, key: str, *, reader: str) -> object:
        """Return a value, copied where it is mutable.

        Raises:
            UserdataError: neither this scope nor an enclosing one has the key; names the reader.
        """
        value = self._find(key)
        if value is _MISSING:
            raise UserdataError(
                f"userdata key {key!r} is read but not defined here", where=reader, hint=did_you_mean(key, self.keys())
            )
        return copy_if_mutable(value)

    def has(self, key: str) -> bool:
        """Return whether a read of `key` succeeds."""
        return self._find(key) is not _MISSING

    def write(self, key: str, value: object) -> str:
        """Write to the scope that owns the key and return its path."""
        scope = self._owner(key) or self
        scope._values[key] = copy_if_mutable(value)
        return scope.path

    def restore(self, path: str, key: str, value: object, *, defined: bool) -> None:
        """Restore a key of the scope at `path`, this or an enclosing one, to a former value or to undefined."""
        scope: Scope | None = self
        while scope is not None and scope.path != path:
            scope = scope.parent
        if scope is None:
            return
        if defined:
            scope._values[key] = copy_if_mutable(value)
        else:
            scope._values.pop(key, None)

    def append(self, key: str, value: object, *, writer: str) -> tuple[str, list[object], bool]:
        """Append to the list in the scope that owns the key, or to a new list; no other code may hold `value`.

        Returns:
            The path of the scope of the list; the list; and whether it is new in that scope: a new list, or the copy
            that a branch makes of an outer list.

        Raises:
            UserdataError: the value is not a list; names the writer.
        """
        scope = self._owner(key) or self
        is_new = key not in scope._values
        before = self._find(key)
        before = list[object]() if before is _MISSING else before
        if not isinstance(before, list):
            kind = type(before).__name__
            message = f"cannot append to {key!r}, which is a {kind}"
            raise UserdataError(message, where=writer, hint="initialize it with []")
        scope._append_only = scope._append_only or AppendOnlyLists()
        values = scope._values[key] = scope._append_only.appended(key, cast("list[object]", before), value)
        return scope.path, values, is_new

    def keys(self) -> Iterator[str]:
        """Yield all keys that are readable from this scope."""
        scope: Scope | None = self
        while scope is not None:
            yield from scope._values
            scope = scope.parent

    def own_values(self) -> dict[str, object]:
        """Return the values of this scope alone, in order of first write."""
        return dict(self._values)

    def visible(self) -> dict[str, object]:
        """Return all values that are readable from this scope; inner values hide outer ones."""
        outer = self.parent.visible() if self.parent is not None else {}
        return {**outer, **self._values}

    def _find(self, key: str) -> object:
        scope: Scope | None = self
        while scope is not None:
            if key in scope._values:
                return scope._values[key]
            scope = scope.parent
        return _MISSING

    def _owner(self, key: str) -> Scope | None:
        scope: Scope | None = self
        among: Scope | None = None
        while scope is not None:
            if key in scope._values or (scope._isolated and key not in scope._shared):
                return scope
            if scope._isolated and among is None:
                among = scope.parent
            scope = scope.parent
        return among


def copy_if_mutable(value: object) -> object:
    """Return `value` itself when it is immutable, else a deep copy, whose size counts as work."""
    if is_immutable(value):
        return value
    copies: dict[int, object] = {}
    copied = copy.deepcopy(value, copies)
    sized = (cast("Sized", each) for each in copies.values() if isinstance(each, list | dict))
    METER.work(_COPY * len(copies) + _COPY_ITEM * sum(map(len, sized)))
    return copied

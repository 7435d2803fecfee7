"""Userdata: the values that states of one container share, scoped like the containers are nested.

A read looks outward from the innermost container; a write goes to the nearest scope that has
the key, else it makes the key in the innermost one. A branch of a concurrency container writes
into a scope of its own that is merged, in document order, when the container finishes; keys that
the container shares are written where they live around it. A behavior reference is a wall: only
what `in` and `out` name passes.
"""

from __future__ import annotations

import copy
from collections.abc import Iterator, Mapping, Sized
from typing import cast

from engine.document.step_meter import METER
from engine.errors import UserdataError
from engine.runtime.userdata.append_only_lists import AppendOnlyLists
from engine.runtime.userdata.userdata_value import is_immutable
from engine.suggestions import did_you_mean

_MISSING = object()
_COPY = 1.5
"""Steps for each list, mapping or other object that is copied."""
_COPY_ITEM = 0.3


class Scope:
    """The values of one container while it is active.

    Args:
        path: The path of the container; that of a branch has `*` behind it.
        values: What it begins with.
        parent: The scope around it.
        isolated: Whether what is written inside stays in it, as in a branch.
        shared: The keys that do not stay in an isolated one.
    """

    __slots__ = ("_grown", "_isolated", "_shared", "_values", "parent", "path")

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
        self._grown: AppendOnlyLists | None = None

    def read(self, key: str, *, reader: str) -> object:
        """Return a value that the reader may change without changing the container's.

        Raises:
            UserdataError: no scope from here outward has the key; names the reader.
        """
        value = self._find(key)
        if value is _MISSING:
            raise UserdataError(
                f"userdata key {key!r} is read but not defined here", where=reader, hint=did_you_mean(key, self.keys())
            )
        return copy_if_mutable(value)

    def has(self, key: str) -> bool:
        """Tell whether a read of `key` would succeed."""
        return self._find(key) is not _MISSING

    def write(self, key: str, value: object) -> str:
        """Set a value where the key lives and return the path of that scope."""
        scope = self._owner(key) or self
        scope._values[key] = copy_if_mutable(value)
        return scope.path

    def restore(self, path: str, key: str, value: object, *, defined: bool) -> None:
        """Let a key of the scope at `path`, this one or one around it, hold a former value, or nothing."""
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
        """Append to the list where the key lives, or to a new one; `value` must be nobody else's.

        Returns:
            The path of the scope that has the list; the list; and whether it is new in that scope: the first value of
            all, or a branch's own copy of a list that lives outside.

        Raises:
            UserdataError: it is no list; names the writer.
        """
        scope = self._owner(key) or self
        is_new = key not in scope._values
        before = self._find(key)
        before = list[object]() if before is _MISSING else before
        if not isinstance(before, list):
            kind = type(before).__name__
            raise UserdataError(f"cannot append to {key!r}, which is a {kind}", where=writer, hint="begin with []")
        scope._grown = scope._grown or AppendOnlyLists()
        grown = scope._values[key] = scope._grown.appended(key, cast("list[object]", before), value)
        return scope.path, grown, is_new

    def keys(self) -> Iterator[str]:
        """Go through all keys that can be read from here."""
        scope: Scope | None = self
        while scope is not None:
            yield from scope._values
            scope = scope.parent

    def own_values(self) -> dict[str, object]:
        """Return the values of this scope alone, in order of first writing."""
        return dict(self._values)

    def visible(self) -> dict[str, object]:
        """Return everything that can be read from here, inner values hiding outer ones."""
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
    """Return `value` itself when nobody can change it, else a deep copy, whose size counts as work."""
    if is_immutable(value):
        return value
    copies: dict[int, object] = {}
    made = copy.deepcopy(value, copies)
    sized = (cast("Sized", each) for each in copies.values() if isinstance(each, list | dict))
    METER.work(_COPY * len(copies) + _COPY_ITEM * sum(map(len, sized)))
    return made

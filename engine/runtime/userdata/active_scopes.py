"""The scopes of a run that are active, by path: what an operator may change while the run is paused."""

from __future__ import annotations

from collections.abc import Mapping
from weakref import WeakValueDictionary

from engine.errors import UserdataError
from engine.runtime.userdata.userdata import Scope
from engine.wording.suggestions import did_you_mean


class ActiveScopes:
    """Opens the scopes of one run; a scope ends with the container that holds it."""

    def __init__(self) -> None:
        self._scopes: WeakValueDictionary[str, Scope] = WeakValueDictionary()

    def open(
        self,
        path: str,
        values: Mapping[str, object],
        parent: Scope | None = None,
        *,
        isolated: bool = False,
        shared: frozenset[str] = frozenset(),
    ) -> Scope:
        """Return a new scope; the arguments are those of `Scope`."""
        scope = self._scopes[path] = Scope(path, values, parent, isolated=isolated, shared=shared)
        return scope

    def with_key(self, key: str) -> tuple[str, ...]:
        """Return the paths of the scopes that have a key themselves, in order."""
        return tuple(sorted(path for path, scope in self._scopes.items() if key in scope.own_values()))

    def owning(self, path: str, key: str) -> Scope:
        """Return the scope at `path`, which has the key `key` itself.

        Raises:
            UserdataError: there is no such scope now, or it has no such key.
        """
        scope = self._scopes.get(path)
        if scope is None:
            paths = [each or "(the behavior)" for each in self._scopes]
            raise UserdataError("no userdata is active there", where=path, hint=did_you_mean(path, paths))
        keys = scope.own_values()
        if key not in keys:
            raise UserdataError(f"there is no userdata key {key!r}", where=path, hint=did_you_mean(key, keys))
        return scope

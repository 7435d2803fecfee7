"""Where a part of a tree reads and writes: the scope of the tree, or its own branch of a parallel."""

from __future__ import annotations

from engine.runtime.userdata.userdata import Scope


class ScopeAccess:
    """Holds the scope of the moment; a parallel gives its branches new ones at each activation."""

    __slots__ = ("scope",)

    def __init__(self, scope: Scope) -> None:
        self.scope = scope

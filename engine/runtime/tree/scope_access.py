"""Access of a tree node to its scope: the scope of the tree, or of its branch of a parallel."""

from __future__ import annotations

from engine.runtime.userdata.userdata import Scope


class ScopeAccess:
    """Holds the current scope; a parallel gives its branches new scopes at each activation."""

    __slots__ = ("scope",)

    def __init__(self, scope: Scope) -> None:
        self.scope = scope

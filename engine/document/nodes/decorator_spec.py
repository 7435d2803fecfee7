"""What every decorator of a tree declares about itself, for check, editor and page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from engine.document.nodes.node_kind import TreeStatus
from engine.document.text.decoding import StrictModel

Turns = Mapping[TreeStatus, tuple[TreeStatus, ...]]
"""The statuses that a decorator may show, by the status of its child; `running` after an end runs the child again."""
MAY_FAIL: Turns = {
    "success": ("success", "failure"),
    "failure": ("failure",),
    "skipped": ("skipped", "failure"),
    "running": ("running", "failure"),
}
"""Of a decorator that shows the status of its child, or fails by itself."""


class DecoratorSpec(StrictModel, frozen=True, kw_only=True):
    """A part of a tree with one `child`: it changes the status of the child, or decides when the child is ticked."""

    icon: ClassVar[str]
    """The name of its icon on the page."""
    doc: ClassVar[str]
    """What it does, in one line, for those who choose it."""
    turns: ClassVar[Turns] = {}
    """Its effect on the status of its child; a status that is absent stays."""

    @property
    def late(self) -> frozenset[TreeStatus]:
        """The statuses that it shows only after a wait of its own."""
        return frozenset()

    def statuses(self, child: TreeStatus) -> tuple[TreeStatus, ...]:
        """Return the statuses that it may show while its child has one."""
        return self.turns.get(child, (child,))

    def why_endless(self, ends: str) -> str:
        """Return why it never ends, although its child ends with `ends`."""
        return "maps SUCCESS and FAILURE of its child to RUNNING"

"""What the rest of a tree asks of a decorator; the defaults are those of one without a memory or a timer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from py_trees.common import Status
from py_trees.decorators import Decorator

from engine.errors import Cause
from engine.runtime.tree.tree_history import TreeNodeState
from engine.runtime.tree.tree_node import TreeNode

STATUSES: Mapping[str, Status] = {"success": Status.SUCCESS, "failure": Status.FAILURE, "running": Status.RUNNING}
"""The statuses of py_trees, by their words in documents and events."""


class TreeDecorator(Decorator):
    """A decorator of a tree.

    Every `tick` yields the decorator itself last: the composite above stops iterating there, so no work may remain.
    """

    refusal = ""
    """Reason of its own failure; empty where the child determines the status."""
    keeps_end: ClassVar[bool] = False
    """Whether it remembers that its child has ended; a skipped child has not."""

    @property
    def ticks_child(self) -> bool:
        """Whether a tick of it, when it has ended, ticks its child."""
        return True

    def reads_end(self, end: Status, *, is_recorded: bool) -> bool:
        """Return whether a RUNNING decorator has yet to read an end of its child that was recorded before a crash.

        `is_recorded` tells that its own last event came after that end.
        """
        return True

    def explain(self, part: TreeNode, below: Cause | None) -> Cause | None:
        """Return the cause of its failure; `below` is that of its child, None where that has not failed."""
        return Cause(message=self.refusal, where=part.path, kind=type(self).__name__) if self.refusal else below

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Restore its memory and timers; `is_reached` is false where no tick comes while the tree waits above."""

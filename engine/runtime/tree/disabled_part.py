"""A disabled part of a tree: skipped at every tick, whatever it is."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.runtime.tree.skipped_nodes import SkippedNodes


class DisabledPart(Behaviour):
    """Has no children and starts nothing; its parent passes over it.

    Args:
        path: The path of the node.
        skips: Records that it is skipped.
    """

    def __init__(self, path: str, skips: SkippedNodes) -> None:
        super().__init__(path)
        self._skips = skips

    def tick(self) -> Iterator[Behaviour]:
        """Take the status by which the parent passes over it."""
        self.status = self._skips.skip(self)
        yield self

    def update(self) -> Status:
        """Return the current status; `tick` sets it."""
        return self.status

    def stop(self, new_status: Status) -> None:
        """Take the new status: nothing is active."""
        self.terminate(new_status)
        self.status = new_status

"""One step of a paused run: which branch is released, and where it stops again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from engine.node_path import is_inside
from engine.runtime.control.breakpoint import GatePoint

StepMode = Literal["into", "over", "out"]
"""The modes of an operator; `SingleStep` also has `back`."""


@dataclass(frozen=True, kw_only=True)
class SingleStep:
    """Releases `branch` from the node `origin` on.

    `into` stops before the next node that is entered, `over` before the next that is not inside
    `origin`, `out` when the container around `origin` has its outcome. `back` releases only nodes in `branch`, until
    the undo pauses the run again.
    """

    mode: StepMode | Literal["back"]
    branch: str
    """The branch that is released; empty for all branches."""
    origin: str

    def frees(self, path: str) -> bool:
        """Return whether the step releases `path`: it is in the branch or around it."""
        if self.mode == "back":
            return is_inside(self.branch, path)
        return not self.branch or is_inside(self.branch, path) or is_inside(path, self.branch)

    def ends_at(self, path: str, point: GatePoint) -> bool:
        """Return whether the step ends at this gate point."""
        if self.mode == "back" or not self.frees(path):
            return False
        container = self.origin.rpartition("/")[0]
        if self.mode == "out" and self.origin:
            return (point == "after" and path == container) or not is_inside(container, path)
        if point == "after":
            return False
        return self.mode == "into" or not self.origin or path == self.origin or not is_inside(self.origin, path)

"""Tree nodes whose first child selects which of the others runs."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite

from engine.runtime.tree.skipped_nodes import SkippedNodes

_FINAL = (Status.SUCCESS, Status.FAILURE)


class IfThenElse(Composite):
    """Ticks its condition until it ends, runs the branch that it selects, and ends with the status of that branch.

    This is IfThenElseNode of BehaviorTree.CPP 4. Without a branch for failure it fails when its condition fails.

    Args:
        path: Its node path.
        children: The condition, the branch for success, and optionally the branch for failure.
        skips: The skipped nodes; this node is skipped when its branch is.
    """

    def __init__(self, path: str, children: list[Behaviour], skips: SkippedNodes) -> None:
        super().__init__(path, children)
        self._skips = skips
        self.condition, *self.branches = children

    @property
    def chosen(self) -> Behaviour | None:
        """The branch that the condition selects; None where it has not ended, or there is no such branch."""
        if self.condition.status not in _FINAL:
            return None
        number = 0 if self.condition.status is Status.SUCCESS else 1
        return self.branches[number] if number < len(self.branches) else None

    def tick(self) -> Iterator[Behaviour]:
        """Tick the condition, unless a branch is selected; then tick the branch."""
        if self.status is not Status.RUNNING:
            self._reset()
        if self.current_child is self.condition:
            yield from self.condition.tick()
            if self.condition.status is Status.RUNNING:
                self.status = Status.RUNNING
                yield self
                return
            self.current_child = self.chosen
        yield from self._tick_branch()

    def _reset(self) -> None:
        for child in self.children:
            if child.status is not Status.INVALID:
                child.stop(Status.INVALID)
        self.current_child = self.condition

    def _tick_branch(self) -> Iterator[Behaviour]:
        branch = self.current_child
        if branch is not None:
            yield from branch.tick()
        status = branch.status if branch is not None else Status.FAILURE
        if branch in self._skips:
            status = self._skips.skip(self)
        else:
            self._skips.run(self)
        if status is not Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self


class WhileDoElse(IfThenElse):
    """Ticks its condition at every tick; halts the branch that is no longer selected before the other begins.

    This is WhileDoElseNode of BehaviorTree.CPP 4: while its condition is RUNNING, the active branch continues.
    """

    def tick(self) -> Iterator[Behaviour]:
        """Tick the condition, halt the branch that is no longer selected, then tick the selected one."""
        if self.status is not Status.RUNNING:
            self._reset()
        yield from self.condition.tick()
        if self.condition.status is Status.RUNNING:
            self.status = Status.RUNNING
            yield self
            return
        self.current_child = chosen = self.chosen
        for branch in self.branches:
            if branch is not chosen and branch.status is not Status.INVALID:
                branch.stop(Status.INVALID)
        yield from self._tick_branch()

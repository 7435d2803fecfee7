"""Skipped nodes of a tree; py_trees has no status for them.

SKIPPED is defined as in BehaviorTree.CPP 4: the node does not run, and its parent passes over it. A skipped node has
the status by which py_trees passes over it in its parent, SUCCESS in a sequence and FAILURE in a selector, and is
registered here. Only nodes with skippable nodes below pay for that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.runtime.tree.tree_decorator import STATUSES, TreeDecorator


class SkippedNodes:
    """The currently skipped nodes of one activation of a tree."""

    def __init__(self) -> None:
        self._passing: dict[Behaviour, Status] = {}
        self.skipped: set[Behaviour] = set()
        """The nodes that were skipped at their last tick."""
        self._passed: dict[Behaviour, set[Behaviour]] = {}
        """The children that each composite has passed over in its current activation."""

    def __contains__(self, part: object) -> bool:
        """Return whether a node is skipped."""
        return part in self.skipped and isinstance(part, Behaviour) and part.status is self._passing[part]

    def __bool__(self) -> bool:
        """Return whether any node is skipped."""
        return bool(self.skipped)

    def place(self, part: Behaviour, passing: Status) -> None:
        """Set the status of a node when it is skipped, by which its parent passes over it."""
        self._passing[part] = passing

    def skip(self, part: Behaviour) -> Status:
        """Mark a node as skipped; return its status."""
        self.skipped.add(part)
        return self.passing(part)

    def passing(self, part: Behaviour) -> Status:
        """Return the status of a node when it is skipped."""
        return self._passing.setdefault(part, Status.SUCCESS)

    def closed(self, part: Behaviour, to: str) -> Status:
        """Return the status of a node whose guard is closed; `to` is success, failure or skipped."""
        if to == "skipped":
            return self.skip(part)
        self.run(part)
        return STATUSES[to]

    def run(self, part: Behaviour) -> None:
        """Mark a node as not skipped."""
        self.skipped.discard(part)

    def forget_all(self) -> None:
        """Remove all nodes; the tree has ended."""
        self._passing.clear()
        self.skipped.clear()
        self._passed.clear()

    def follow(self, part: Behaviour) -> None:
        """Track a node: a composite is skipped when all its children are, a decorator when its child is."""
        if isinstance(part, TreeDecorator):
            self._follow_child(part)
        elif isinstance(part, composites.Composite):
            self._passed[part] = set()
            vars(part)["tick"] = self._ticked(part, part.tick)

    def restore(self, part: Behaviour, passed: Iterable[Behaviour]) -> None:
        """Restore the children that an active composite has passed over."""
        if part in self._passed:
            self._passed[part].update(passed)

    def _ticked(
        self, part: composites.Composite, own: Callable[[], Iterator[Behaviour]]
    ) -> Callable[[], Iterator[Behaviour]]:
        passed = self._passed[part]

        def tick() -> Iterator[Behaviour]:
            if part.status is not Status.RUNNING:
                passed.clear()
            for step in own():
                if step is part:
                    self._update_skipped(part)
                elif step in self:
                    passed.add(step)
                else:
                    passed.discard(step)
                yield step

        return tick

    def _update_skipped(self, part: composites.Composite) -> None:
        if not self._passed[part].issuperset(part.children):
            self.run(part)
        elif part.status is Status.RUNNING:
            # A parallel that waits for skipped children.
            part.stop(self.skip(part))
        else:
            part.status = self.skip(part)

    def _follow_child(self, part: TreeDecorator) -> None:
        own_update, own_terminate = part.update, part.terminate

        def update() -> Status:
            if part.decorated in self:
                return self.skip(part)
            self.run(part)
            return own_update()

        def terminate(new_status: Status) -> None:
            if not (part.keeps_end and part in self.skipped):
                own_terminate(new_status)

        vars(part)["update"] = update
        vars(part)["terminate"] = terminate

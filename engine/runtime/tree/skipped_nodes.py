"""Which parts of a tree have been skipped: py_trees has no status for that.

SKIPPED is that of BehaviorTree.CPP 4: a part that was not to run at all, which the part around it passes over. A part
that is skipped has the status by which py_trees passes over it there, SUCCESS in a sequence and FAILURE in a selector,
and is marked here beside it. Only parts below which something can be skipped pay for that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from engine.runtime.tree.decorators import Cooldown


class SkippedNodes:
    """The parts of one activation of a tree that are skipped at present."""

    def __init__(self) -> None:
        self._passing: dict[Behaviour, Status] = {}
        self.skipped: set[Behaviour] = set()
        """Those that were skipped when they were last due."""
        self._passed: dict[Behaviour, set[Behaviour]] = {}
        """The children that each composite has passed over in its present activation."""

    def __contains__(self, part: object) -> bool:
        """Tell whether a part is skipped."""
        return part in self.skipped and isinstance(part, Behaviour) and part.status is self._passing[part]

    def __bool__(self) -> bool:
        """Tell whether anything has been skipped."""
        return bool(self.skipped)

    def place(self, part: Behaviour, passing: Status) -> None:
        """Let a part have this status when it is skipped: the part around it passes over that."""
        self._passing[part] = passing

    def skip(self, part: Behaviour) -> Status:
        """Mark a part as skipped; return the status that it is to have."""
        self.skipped.add(part)
        return self.passing(part)

    def passing(self, part: Behaviour) -> Status:
        """Return the status that a part has when it is skipped."""
        return self._passing.setdefault(part, Status.SUCCESS)

    def run(self, part: Behaviour) -> None:
        """Mark a part as one that was run."""
        self.skipped.discard(part)

    def forget_all(self) -> None:
        """Forget all parts; the tree has ended."""
        self._passing.clear()
        self.skipped.clear()
        self._passed.clear()

    def follow(self, part: Behaviour) -> None:
        """Have a composite be skipped when all its children are, and a decorator when its child is."""
        if isinstance(part, Decorator):
            self._follow_child(part)
        elif isinstance(part, composites.Composite):
            self._passed[part] = set()
            vars(part)["tick"] = self._ticked(part, part.tick)

    def restore(self, part: Behaviour, passed: Iterable[Behaviour]) -> None:
        """Let a composite that is at work have passed over these children."""
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
                    self._judge(part)
                elif step in self:
                    passed.add(step)
                else:
                    passed.discard(step)
                yield step

        return tick

    def _judge(self, part: composites.Composite) -> None:
        if not self._passed[part].issuperset(part.children):
            self.run(part)
        elif part.status is Status.RUNNING:
            # A parallel that waits for what was not to run.
            part.stop(self.skip(part))
        else:
            part.status = self.skip(part)

    def _follow_child(self, part: Decorator) -> None:
        own_update, own_terminate = part.update, part.terminate

        def update() -> Status:
            if part.decorated in self:
                return self.skip(part)
            self.run(part)
            return own_update()

        def terminate(new_status: Status) -> None:
            # Nothing has ended that was to be remembered, or to cool down.
            if not (part in self.skipped and isinstance(part, decorators.OneShot | Cooldown)):
                own_terminate(new_status)

        vars(part)["update"] = update
        vars(part)["terminate"] = terminate

"""py_trees' Parallel with a userdata scope for each branch, merged in document order when it ends; with thresholds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from engine.runtime.nodes.concurrency import branch_scope, merge_scope
from engine.runtime.nodes.execution import Execution
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.skipped_nodes import SkippedNodes


class Parallel(composites.Parallel):
    """Branches do not see what the others write until the parallel has ended, as in a concurrency container.

    Args:
        path: Its node path.
        policy: Whose success is its own.
        children: The branches.
        places: Where each branch reads and writes, by name, in document order.
        outside: Where the parallel itself stands.
        execution: The run.
        skips: Which parts are skipped.
    """

    def __init__(
        self,
        path: str,
        policy: ParallelPolicy.Base,
        children: Sequence[Behaviour],
        *,
        places: Mapping[str, ScopeAccess],
        outside: ScopeAccess,
        execution: Execution,
        skips: SkippedNodes,
    ) -> None:
        super().__init__(path, policy, children)
        self.skips = skips
        self._places = places
        self._outside = outside
        self._execution = execution

    def initialise(self) -> None:
        """Give each branch a scope of its own."""
        for name, place in self._places.items():
            place.scope = branch_scope(self.name, name, self._outside.scope, {})

    def restore(self, written: Mapping[str, Mapping[str, object]]) -> None:
        """Give each branch the scope it had, by the path of the branch."""
        for name, place in self._places.items():
            values = written.get(f"{self.name}/{name}", {})
            place.scope = branch_scope(self.name, name, self._outside.scope, values)

    def terminate(self, new_status: Status) -> None:
        """Merge what was written, unless the parallel was halted."""
        if new_status is not Status.INVALID:
            for place in self._places.values():
                merge_scope(place.scope, self._outside.scope, self._execution)


class ThresholdPolicy(ParallelPolicy.Base):
    """How many children must succeed, all that are not skipped where that is None, and how many must fail."""

    def __init__(self, success_count: int | None, failure_count: int) -> None:
        super().__init__(synchronise=True)
        self.success_count = success_count
        self.failure_count = failure_count


class ThresholdParallel(Parallel):
    """Its policy is `ThresholdPolicy`; children that have ended are not run again meanwhile.

    This is ParallelNode of BehaviorTree.CPP 4: it fails as well when too few children are left to succeed.
    """

    @property
    def success_count(self) -> int:
        """How many children must succeed."""
        needed = self._thresholds.success_count
        return len(self.children) - self._skipped if needed is None else needed

    @property
    def _skipped(self) -> int:
        return sum(child in self.skips for child in self.children)

    @property
    def _thresholds(self) -> ThresholdPolicy:
        assert isinstance(self.policy, ThresholdPolicy)
        return self.policy

    @property
    def failed(self) -> int:
        """How many children have failed."""
        return sum(child.status is Status.FAILURE for child in self.children)

    @property
    def verdict(self) -> Status:
        """What follows from how the children stand."""
        succeeded = sum(child.status is Status.SUCCESS for child in self.children)
        left = len(self.children) - self.failed - self._skipped
        if succeeded >= self.success_count:
            return Status.SUCCESS
        if self.failed >= self._thresholds.failure_count or left < self.success_count:
            return Status.FAILURE
        return Status.RUNNING

    def tick(self) -> Iterator[Behaviour]:
        """Tick the children that have not ended, then judge."""
        if self.status is not Status.RUNNING:
            for child in self.children:
                if child.status is not Status.INVALID:
                    child.stop(Status.INVALID)
            self.initialise()
        for child in self.children:
            if child.status not in (Status.SUCCESS, Status.FAILURE) and child not in self.skips:
                yield from child.tick()
        self.current_child = self.children[-1]
        verdict = self.verdict
        if verdict is not Status.RUNNING:
            self.stop(verdict)
        self.status = verdict
        yield self

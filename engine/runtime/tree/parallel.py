"""Parallel of py_trees with a userdata scope for each branch, merged in document order at its end; thresholds."""

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
    """Branches see writes of other branches only after the parallel has ended, as in a concurrency container.

    Args:
        path: Its node path.
        policy: Determines whose success it requires.
        children: The branches.
        places: Access to the scope of each branch, by name, in document order.
        outside: Access to the enclosing scope.
        execution: The execution of the run.
        skips: The skipped nodes.
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
        """Create a scope for each branch."""
        for name, place in self._places.items():
            place.scope = branch_scope(self.name, name, self._outside.scope, {}, self._execution)

    def restore(self, written: Mapping[str, Mapping[str, object]]) -> None:
        """Restore the scope of each branch from its values, by the path of the branch."""
        for name, place in self._places.items():
            values = written.get(f"{self.name}/{name}", {})
            place.scope = branch_scope(self.name, name, self._outside.scope, values, self._execution)

    def terminate(self, new_status: Status) -> None:
        """Merge the scopes of the branches, unless the parallel was halted."""
        if new_status is not Status.INVALID:
            for place in self._places.values():
                merge_scope(place.scope, self._outside.scope, self._execution)


class ThresholdPolicy(ParallelPolicy.Base):
    """Number of children that must succeed (None: all that are not skipped), and number that must fail."""

    def __init__(self, success_count: int | None, failure_count: int) -> None:
        super().__init__(synchronise=True)
        self.success_count = success_count
        self.failure_count = failure_count


class ThresholdParallel(Parallel):
    """A parallel with `ThresholdPolicy`; ended children do not run again meanwhile.

    This is ParallelNode of BehaviorTree.CPP 4; it also fails when too few children remain to succeed.
    """

    @property
    def success_count(self) -> int:
        """Number of children that must succeed."""
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
        """Number of failed children."""
        return sum(child.status is Status.FAILURE for child in self.children)

    @property
    def verdict(self) -> Status:
        """Status that follows from the statuses of the children."""
        succeeded = sum(child.status is Status.SUCCESS for child in self.children)
        left = len(self.children) - self.failed - self._skipped
        if succeeded >= self.success_count:
            return Status.SUCCESS
        if self.failed >= self._thresholds.failure_count or left < self.success_count:
            return Status.FAILURE
        return Status.RUNNING

    def tick(self) -> Iterator[Behaviour]:
        """Tick the children that have not ended, then evaluate the thresholds."""
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

"""The concurrency container: children in parallel branches, ended by the first satisfied condition."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Coroutine, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial

from engine.cause_chain import wrap_cause
from engine.document.nodes.concurrency_condition import ConcurrencyCondition, deciding, preempting
from engine.errors import Cause, StateError
from engine.event import BranchesPreempted
from engine.preemption import BackgroundPreemptions, preempt, raise_failure
from engine.runtime.nodes.diagnosis import explain_exit, is_failure
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry, WithoutEntry
from engine.runtime.nodes.overdue_nodes import overdue_policy
from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.runtime.record.node_exit import PREEMPTED, ContainerOutcome, NodeExit
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome


@dataclass(frozen=True, kw_only=True)
class Concurrency(WithoutEntry):
    """Children by name and conditions, both in document order."""

    children: Mapping[str, Node]
    conditions: tuple[ConcurrencyCondition, ...]
    otherwise: str | None = None
    userdata: Mapping[str, object] = field(default_factory=dict[str, object])
    shared: frozenset[str] = frozenset()
    """The keys whose writes all branches see at once."""

    @property
    def kind(self) -> str:
        """The key of this container in documents."""
        return "concurrency"

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """The outcomes of its conditions, and `otherwise`."""
        otherwise = (self.otherwise,) if self.otherwise is not None else ()
        return tuple(dict.fromkeys((*(condition.outcome for condition in self.deciding), *otherwise)))

    @cached_property
    def deciding(self) -> tuple[ConcurrencyCondition, ...]:
        """The conditions that decide the outcome, in order of precedence."""
        return deciding(self.conditions)

    @cached_property
    def preempting(self) -> tuple[ConcurrencyCondition, ...]:
        """The conditions that preempt some children while the others continue."""
        return preempting(self.conditions)

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Outcomes of conditions that require only nominal outcomes of the children."""
        return frozenset(
            c.outcome
            for c in self.deciding
            if c.asks_only_for(lambda name, due: due in self.children[name].work.nominal)
        )

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return the initial values of its scope."""
        return self.userdata

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Start all children, evaluate the conditions whenever some finish, preempt and await the others."""
        point = entry.point
        inner = execution.scopes.open(path, point.values if point is not None else self.userdata, scope)
        branches = _Branches(path, inner, execution, point)
        execution.branching[path] = branches
        branches.start(self)
        try:
            outcome = await self._decided(path, branches, execution)
        except asyncio.CancelledError:
            raise_failure(branches.tasks.values())
            raise
        raise_failure(branches.tasks.values())
        branches.merge_all()
        return outcome

    async def _decided(self, path: str, branches: _Branches, execution: Execution) -> Outcome:
        """Return the decided outcome once all branches have ended."""
        try:
            return await self._decide(path, branches, execution)
        finally:
            execution.branching.pop(path, None)
            await branches.end(branches.tasks)

    async def _decide(self, path: str, branches: _Branches, execution: Execution) -> Outcome:
        latest = self
        while True:
            await branches.arrival.wait()
            await execution.settlement.settled(path)
            branches.arrival.clear()
            latest = execution.latest(f"{path}/", latest)
            if branches.are_others(latest):
                await branches.follow(latest)
            finished = branches.finished(latest)
            for condition in latest.deciding:
                if condition.holds(finished_with(finished)):
                    return latest.ended(condition, finished)
            if len(finished) == len(branches.tasks):
                return latest._uncovered(path, finished)
            branches.preempt_by(latest.preempting)

    def ended(self, condition: ConcurrencyCondition, finished: Mapping[str, NodeExit]) -> ContainerOutcome:
        """Return the outcome of a condition that holds, with the children that it requires as the reason."""
        matches = finished_with(finished)
        exits = [
            explain_exit(self.children[name], finished[name])
            for name, required in condition.when.items()
            if matches(name, required)
        ]
        message = " and ".join(each.message for each in exits)
        reason = exits[0] if len(exits) == 1 else Cause(message=message, where=exits[0].where.rpartition("/")[0])
        return ContainerOutcome(condition.outcome, cause=self._cause(condition.outcome, finished), reason=reason)

    def _cause(self, outcome: str, finished: Mapping[str, NodeExit]) -> Cause | None:
        if outcome in self.nominal:
            return None
        for name, child in self.children.items():
            left = finished.get(name)
            if left is not None and is_failure(child, left):
                return explain_exit(child, left)
        return None

    def _uncovered(self, path: str, finished: Mapping[str, NodeExit]) -> Outcome:
        exits = ", ".join(f"{name}: {left.outcome or 'preempted'}" for name, left in finished.items())
        if self.otherwise is None:
            raise StateError(
                f"all children have finished ({exits}) and no condition matches",
                where=path,
                hint="add a condition for this combination, or `otherwise`",
            )
        return Outcome(
            self.otherwise,
            cause=wrap_cause(f"no condition matches ({exits})", self._cause(self.otherwise, finished), where=path),
        )


class _Branches:
    """The branches of one activation of a concurrency container: their tasks, scopes and exits."""

    def __init__(self, path: str, inner: Scope, execution: Execution, point: NodeCheckpoint | None) -> None:
        self.tasks: dict[str, asyncio.Task[NodeExit]] = {}
        self.arrival = asyncio.Event()
        self._path = path
        self._inner = inner
        self._execution = execution
        self._before = point if point is not None else NodeCheckpoint(visit=0)
        self._scopes: dict[str, Scope] = {}
        self._arrived: list[str] = []
        self._finished: dict[str, NodeExit] = {}
        self._preempted = {name for names in self._before.preempted.values() for name in names}
        self._fired = set(self._before.preempted)
        self._preemptions = BackgroundPreemptions(overdue_policy(execution, path), self.wake)
        if not execution.is_resumed:
            for condition, names in self._before.preempted.items():
                execution.recorder.emit(BranchesPreempted, path=path, condition=condition, branches=names)

    def wake(self) -> None:
        """Let the container evaluate its conditions again."""
        self.arrival.set()

    def start(self, container: Concurrency) -> None:
        """Start the children that are not started yet."""
        fresh = {name: child for name, child in container.children.items() if name not in self.tasks}
        for name in fresh:
            written = self._before.branches.get(name, {})
            self._scopes[name] = branch_scope(
                self._path, name, self._inner, written, self._execution, shared=container.shared
            )
        for name, child in fresh.items():
            self.tasks[name] = self._execution.activity.branch(child.path, self._work(name, child))
        for name in fresh:
            self.tasks[name].add_done_callback(partial(self._arrive, name))
        if self._preempted:
            self.wake()

    def _work(self, name: str, child: Node) -> Coroutine[None, None, NodeExit]:
        if name in self._preempted and child.path not in self._execution.points:
            return _ended_before(child.path, self._before.failed_clean_ups.get(name))
        return child.perform(self._scopes[name], self._execution)

    def are_others(self, container: Concurrency) -> bool:
        """Return whether a hot change has changed the set of branches."""
        return self.tasks.keys() != container.children.keys()

    async def follow(self, container: Concurrency) -> None:
        """Preempt the removed branches, whose writes are already merged, and start the added ones."""
        removed = [name for name in self.tasks if name not in container.children]
        await self.end(removed)
        for name in removed:
            self._execution.branch_holds.has_cleaned_up(f"{self._path}/{name}")
            task = self.tasks.pop(name)
            raise_failure((task,))
            self._finished.pop(name, None)
            self._preempted.discard(name)
            self._scopes.pop(name)
        self.start(container)

    def finished(self, container: Concurrency) -> Mapping[str, NodeExit]:
        """Return the exits of the finished branches, in the order in which they finished.

        Raises:
            NotStopped: a preempted branch was abandoned.
        """
        self._preemptions.raise_failure()
        arrived = [name for name in self._arrived if name in self.tasks]
        self._arrived.clear()
        rank = list(container.children).index
        for name in sorted(arrived, key=rank):
            self._finished[name] = self._left(name)
        return self._finished

    def _left(self, name: str) -> NodeExit:
        task = self.tasks[name]
        # A branch that was cleaning up when the engine died may end differently now, but counts as preempted.
        if name in self._preempted and (task.cancelled() or task.exception() is None):
            return PREEMPTED
        return _as_outcome(task.result())

    def preempt_by(self, conditions: Iterable[ConcurrencyCondition]) -> None:
        """Preempt, in order, the branches of conditions that hold for the first time."""
        matches = finished_with(self._finished)
        for condition in conditions:
            if condition.text not in self._fired and condition.holds(matches):
                self._fired.add(condition.text)
                self._record(condition)
        for name, task in self.tasks.items():
            if name in self._preempted and not task.done():
                self._preemptions.begin(task)

    def _record(self, condition: ConcurrencyCondition) -> None:
        over = self._preempted.union(self._finished)
        names = tuple(name for name in self.tasks if name in condition.preempt and name not in over)
        self._preempted.update(names)
        self._execution.recorder.emit(BranchesPreempted, path=self._path, condition=condition.text, branches=names)

    async def end(self, names: Collection[str]) -> None:
        """Preempt the given branches that have not ended, and return when they have.

        Raises:
            NotStopped: a branch was abandoned.
            CancelledError: the caller was cancelled meanwhile; the branches have ended nevertheless.
        """
        tasks = [self.tasks[name] for name in names]
        try:
            others = [task for task in tasks if task not in self._preemptions]
            await preempt(others, overdue_policy(self._execution, self._path))
        finally:
            await self._preemptions.finish(tasks)

    def merge(self, name: str) -> None:
        """Write the values of a branch to the enclosing scopes that own the keys."""
        merge_scope(self._scopes[name], self._inner, self._execution)

    def merge_all(self) -> None:
        """Merge all branches, in order of their starts."""
        for name in self._scopes:
            self.merge(name)

    def _arrive(self, name: str, _: asyncio.Task[NodeExit]) -> None:
        self._arrived.append(name)
        self.arrival.set()


def finished_with(finished: Mapping[str, NodeExit]) -> Callable[[str, str], bool]:
    """Return the predicate for conditions: whether a child has finished with an outcome."""
    return lambda name, due: name in finished and finished[name].outcome == due


async def _ended_before(path: str, failure: Cause | None) -> NodeExit:
    """End like a branch that was preempted before the engine died."""
    if failure is not None:
        raise StateError(failure.message, where=path)
    raise asyncio.CancelledError


def _as_outcome(left: NodeExit) -> NodeExit:
    """Convert the target of a child diverted by timeout or on_error to its outcome."""
    return left if left.target is None else NodeExit(left.target, None, left.cause, left.reason)


def branch_scope(
    path: str,
    name: str,
    outer: Scope,
    written: Mapping[str, object],
    execution: Execution,
    *,
    shared: frozenset[str] = frozenset(),
) -> Scope:
    """Return the scope of one branch, which keeps its writes until the branches are merged, except shared keys."""
    return execution.scopes.open(f"{path}/{name}*", written, outer, isolated=True, shared=shared)


def merge_scope(branch: Scope, into: Scope, execution: Execution) -> None:
    """Write the values of a branch to the enclosing scopes that own the keys."""
    for key, value in branch.own_values().items():
        execution.write(branch.path.removesuffix("*"), into, key, value)

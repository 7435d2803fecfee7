"""The concurrency container: children side by side, ended by the first satisfied condition."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial

from engine.cause import under
from engine.diagnosis import explain, went_wrong
from engine.document.condition import Condition
from engine.entry import NOTHING, Entry
from engine.errors import StateError
from engine.event import Cause
from engine.execution import Execution
from engine.node import Node, overdue
from engine.node_exit import ContainerOutcome, Left
from engine.preemption import preempt, raise_failure
from engine.state import Outcome
from engine.userdata import Scope


@dataclass(frozen=True, kw_only=True)
class Concurrency:
    """Children by name and conditions, both in document order."""

    children: Mapping[str, Node]
    conditions: tuple[Condition, ...]
    otherwise: str | None = None
    userdata: Mapping[str, object] = field(default_factory=dict[str, object])
    shared: frozenset[str] = frozenset()
    """The keys that branches see each other write."""

    @property
    def kind(self) -> str:
        """The key of this container in documents."""
        return "concurrency"

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """Those of its conditions, and `otherwise`."""
        otherwise = (self.otherwise,) if self.otherwise is not None else ()
        return tuple(dict.fromkeys((*(condition.outcome for condition in self.conditions), *otherwise)))

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Outcomes of conditions that ask only for nominal outcomes of the children."""
        return frozenset(
            c.outcome
            for c in self.conditions
            if c.asks_only_for(lambda name, due: due in self.children[name].work.nominal)
        )

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """The values its scope begins with."""
        return self.userdata

    @property
    def constant(self) -> Entry:
        """Nothing."""
        return NOTHING

    def enter(self, scope: Scope) -> Entry:
        """Nothing is evaluated: the children evaluate theirs."""
        return NOTHING

    async def run(self, entry: Entry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Start all children, decide whenever some have finished, preempt and await the others."""
        point = entry.point
        inner = Scope(path, point.values if point is not None else self.userdata, scope)
        written: Mapping[str, Mapping[str, object]] = point.branches if point is not None else {}
        branches = _Branches(path, inner, execution, written)
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
        """Return what was decided, once all branches have ended."""
        try:
            return await self._decide(path, branches, execution)
        finally:
            execution.branching.pop(path, None)
            await preempt(branches.tasks.values(), overdue(execution, path))

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
            for condition in latest.conditions:
                if condition.holds(has_ended(finished)):
                    return latest.ended(condition, finished)
            if len(finished) == len(branches.tasks):
                return latest._uncovered(path, finished)

    def ended(self, condition: Condition, finished: Mapping[str, Left]) -> ContainerOutcome:
        """Return its outcome by a condition that holds, with the children that this asked for as the reason."""
        so = has_ended(finished)
        asked = [explain(self.children[name], finished[name]) for name, due in condition.when.items() if so(name, due)]
        together = " and ".join(each.message for each in asked)
        reason = asked[0] if len(asked) == 1 else Cause(message=together, where=asked[0].where.rpartition("/")[0])
        return ContainerOutcome(condition.outcome, cause=self._cause(condition.outcome, finished), reason=reason)

    def _cause(self, outcome: str, finished: Mapping[str, Left]) -> Cause | None:
        if outcome in self.nominal:
            return None
        for name, child in self.children.items():
            left = finished.get(name)
            if left is not None and went_wrong(child, left):
                return explain(child, left)
        return None

    def _uncovered(self, path: str, finished: Mapping[str, Left]) -> Outcome:
        how = ", ".join(f"{name}: {left.outcome}" for name, left in finished.items())
        if self.otherwise is None:
            raise StateError(
                f"all children have finished ({how}) and no condition matches",
                where=path,
                hint="add a condition for this combination, or `otherwise`",
            )
        return Outcome(
            self.otherwise,
            cause=under(f"no condition matches ({how})", self._cause(self.otherwise, finished), where=path),
        )


class _Branches:
    """The branches of one activation of a concurrency container: their tasks and scopes, and who has ended."""

    def __init__(
        self, path: str, inner: Scope, execution: Execution, written: Mapping[str, Mapping[str, object]]
    ) -> None:
        self.tasks: dict[str, asyncio.Task[Left]] = {}
        self.arrival = asyncio.Event()
        self._path = path
        self._inner = inner
        self._execution = execution
        self._written = written
        self._scopes: dict[str, Scope] = {}
        self._arrived: list[str] = []
        self._finished: dict[str, Left] = {}

    def wake(self) -> None:
        """Have the container look again."""
        self.arrival.set()

    def start(self, container: Concurrency) -> None:
        """Start the children that have not been started."""
        fresh = {name: child for name, child in container.children.items() if name not in self.tasks}
        for name in fresh:
            self._scopes[name] = branch_scope(
                self._path, name, self._inner, self._written.get(name, {}), shared=container.shared
            )
        for name, child in fresh.items():
            work = child.perform(self._scopes[name], self._execution)
            self.tasks[name] = self._execution.activity.branch(child.path, work)
        for name in fresh:
            self.tasks[name].add_done_callback(partial(self._arrive, name))

    def are_others(self, container: Concurrency) -> bool:
        """Tell whether a hot change has given the container other branches."""
        return self.tasks.keys() != container.children.keys()

    async def follow(self, container: Concurrency) -> None:
        """Preempt the branches that are gone, whose writes are merged, and start those that are new."""
        gone = [name for name in self.tasks if name not in container.children]
        await preempt([self.tasks[name] for name in gone], overdue(self._execution, self._path))
        for name in gone:
            self._execution.suspensions.has_cleaned_up(f"{self._path}/{name}")
            task = self.tasks.pop(name)
            raise_failure((task,))
            self._finished.pop(name, None)
            self._scopes.pop(name)
        self.start(container)

    def finished(self, container: Concurrency) -> Mapping[str, Left]:
        """Return how those have ended that have, in the order in which they did."""
        arrived = [name for name in self._arrived if name in self.tasks]
        self._arrived.clear()
        rank = list(container.children).index
        for name in sorted(arrived, key=rank):
            self._finished[name] = _as_outcome(self.tasks[name].result())
        return self._finished

    def merge(self, name: str) -> None:
        """Write what a branch has written where the keys live around it."""
        merge(self._scopes[name], self._inner, self._execution)

    def merge_all(self) -> None:
        """Do so for all, in order of their beginnings."""
        for name in self._scopes:
            self.merge(name)

    def _arrive(self, name: str, _: asyncio.Task[Left]) -> None:
        self._arrived.append(name)
        self.arrival.set()


def has_ended(finished: Mapping[str, Left]) -> Callable[[str, str], bool]:
    """Return what a condition asks: whether a child has finished with an outcome."""
    return lambda name, due: name in finished and finished[name].outcome == due


def _as_outcome(left: Left) -> Left:
    """Give a child that was left by timeout or on_error the outcome named there."""
    return left if left.target is None else Left(left.target, None, left.cause, left.reason)


def branch_scope(
    path: str, name: str, outer: Scope, written: Mapping[str, object], *, shared: frozenset[str] = frozenset()
) -> Scope:
    """Return the scope of one branch, in which its writes stay until the branches are merged, but for shared keys."""
    return Scope(f"{path}/{name}*", written, outer, isolated=True, shared=shared)


def merge(branch: Scope, into: Scope, execution: Execution) -> None:
    """Write what a branch has written where the keys live around it."""
    for key, value in branch.own_values().items():
        execution.write(branch.path.removesuffix("*"), into, key, value)

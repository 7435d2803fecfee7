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
from engine.preemption import preempt
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

    @cached_property
    def _rank(self) -> dict[str, int]:
        return {name: rank for rank, name in enumerate(self.children)}

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
        branches = {
            name: branch_scope(path, name, inner, written.get(name, {}), shared=self.shared) for name in self.children
        }
        tasks = {
            name: execution.activity.branch(child.path, child.perform(branches[name], execution))
            for name, child in self.children.items()
        }
        try:
            outcome = await self._decide(path, tasks, execution)
        finally:
            await preempt(tasks.values(), overdue(execution, path))
        _raise_late_failure(tasks)
        for name in self.children:
            merge(branches[name], inner, execution)
        return outcome

    async def _decide(self, path: str, tasks: Mapping[str, asyncio.Task[Left]], execution: Execution) -> Outcome:
        finished: dict[str, Left] = {}
        ended = asyncio.Event()
        arrived: list[str] = []
        for name, task in tasks.items():
            task.add_done_callback(partial(_arrive, arrived, name, ended))
        while len(finished) < len(tasks):
            await ended.wait()
            await execution.settlement.settled(path)
            ended.clear()
            for name in sorted(arrived, key=self._rank.__getitem__):
                finished[name] = _as_outcome(tasks[name].result())
            arrived.clear()
            for condition in execution.latest(f"{path}/", self).conditions:
                if condition.holds(has_ended(finished)):
                    return self.ended(condition, finished)
        return self._uncovered(path, finished)

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


def has_ended(finished: Mapping[str, Left]) -> Callable[[str, str], bool]:
    """Return what a condition asks: whether a child has finished with an outcome."""
    return lambda name, due: name in finished and finished[name].outcome == due


def _arrive(arrived: list[str], name: str, ended: asyncio.Event, _: asyncio.Task[Left]) -> None:
    arrived.append(name)
    ended.set()


def _as_outcome(left: Left) -> Left:
    """Give a child that was left by timeout or on_error the outcome named there."""
    return left if left.target is None else Left(left.target, None, left.cause, left.reason)


def _raise_late_failure(tasks: Mapping[str, asyncio.Task[Left]]) -> None:
    """A child whose clean-up failed is an error, though another had decided the outcome."""
    for task in tasks.values():
        if not task.cancelled() and (error := task.exception()) is not None:
            raise error


def branch_scope(
    path: str, name: str, outer: Scope, written: Mapping[str, object], *, shared: frozenset[str] = frozenset()
) -> Scope:
    """Return the scope of one branch, in which its writes stay until the branches are merged, but for shared keys."""
    return Scope(f"{path}/{name}*", written, outer, isolated=True, shared=shared)


def merge(branch: Scope, into: Scope, execution: Execution) -> None:
    """Write what a branch has written where the keys live around it."""
    for key, value in branch.own_values().items():
        execution.write(branch.path.removesuffix("*"), into, key, value)

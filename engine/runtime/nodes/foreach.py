"""The foreach container: runs its child once for each item of a list, or a number of times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

from engine.document.count import whole_number
from engine.document.expression.expression import Template
from engine.document.nodes.node_spec import FOREACH_OUTCOMES
from engine.errors import Cause, StateError, UserdataError
from engine.event import TransitionTaken
from engine.runtime.nodes.diagnosis import Diagnosis, explain_exit
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry
from engine.runtime.record.node_exit import ContainerOutcome
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome

_ITEMS = "items"
_TIMES = "times"
_FAIRNESS = 256
MAX_TIMES = 1_000_000_000
MAX_ITEMS = 100_000
MAX_COLLECTED = 100_000
EXHAUSTED, BROKEN = FOREACH_OUTCOMES


@dataclass(frozen=True, kw_only=True)
class ForEach:
    """Rounds over the value of `items`: a list, or with `counted` a number of rounds."""

    child: Node
    items: Template
    counted: bool
    item: str
    index: str | None
    next: frozenset[str]
    collect: Mapping[str, str]
    userdata: Mapping[str, object] = field(default_factory=dict[str, object])
    position: str = ""

    @property
    def kind(self) -> str:
        """The key of this container in documents."""
        return "foreach"

    @property
    def children(self) -> Mapping[str, Node]:
        """The child that runs in each round."""
        return {"child": self.child}

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """`exhausted` after all rounds, else `broken`."""
        return FOREACH_OUTCOMES

    @cached_property
    def nominal(self) -> frozenset[str]:
        """`exhausted`."""
        return frozenset((EXHAUSTED,))

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return nothing: each round has its own scope."""
        return {}

    @property
    def constant(self) -> None:
        """None: the entry depends on userdata."""
        return None

    def enter(self, scope: Scope) -> NodeEntry:
        """Evaluate the items once, for all rounds."""
        value = self.items.evaluate({name: scope.read(name, reader=self.position) for name in self.items.names})
        if self.counted:
            times = whole_number(value)
            if times is None:
                raise StateError(
                    f"`times` evaluates to {value!r}", where=self.position, hint="it must be a whole number, 0 or more"
                )
            self._limit_rounds(times, MAX_TIMES)
            shown: dict[str, object] = {_TIMES: times}
        elif isinstance(value, list | tuple):
            items = list(cast("list[object]", value))
            self._limit_rounds(len(items), MAX_ITEMS)
            shown = {_ITEMS: items}
        else:
            kind = type(value).__name__
            raise StateError(f"`items` evaluates to a {kind}", where=self.position, hint="it must be a list")
        return NodeEntry(None, shown, shown)

    def _limit_rounds(self, rounds: int, limit: int) -> None:
        if rounds > limit:
            message = f"{rounds:,} rounds exceed the limit of {limit:,}"
            raise StateError(message, where=self.position, hint="nest two foreach containers, or loop in a machine")

    @staticmethod
    def items_of(inputs: Mapping[str, object]) -> Sequence[object]:
        """Return the item of each round of a container that was entered with these inputs."""
        times = inputs.get(_TIMES)
        return range(times) if isinstance(times, int) else cast("list[object]", inputs.get(_ITEMS, []))

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Run the child in consecutive rounds, each in its own scope."""
        point = entry.point
        items = self.items_of(entry.inputs)
        first = point.round if point is not None else 0
        diagnosis = Diagnosis(point.cause, point.reason) if point is not None else Diagnosis()
        if point is not None and point.current in FOREACH_OUTCOMES:
            return diagnosis.outcome(point.current, self.nominal)
        loop = self
        for number in range(first, len(items)):
            resumed = point is not None and number == first and point.values
            own = point.values if point is not None and resumed else loop.round_values(number, items[number])
            inner = execution.scopes.open(f"{path}#{number}", own, scope)
            left = await loop.child.perform(inner, execution)
            loop = execution.latest(f"{path}/", loop)
            continues = (left.target or left.outcome) in loop.next
            last = number == len(items) - 1
            if continues:
                loop._collect(inner, scope, path, execution)
            target = (EXHAUSTED if last else "child") if continues else BROKEN
            execution.recorder.emit(TransitionTaken, path=path, source="child", outcome=left.outcome, target=target)
            diagnosis.take(loop.child, left)
            if not continues:
                return Outcome(BROKEN, cause=explain_exit(loop.child, left))
            if number % _FAIRNESS == 0:
                await execution.yield_turn()
        no_items = Cause(message="there was no item to iterate over", where=path)
        return ContainerOutcome(EXHAUSTED, reason=diagnosis.reason if len(items) else no_items)

    def round_values(self, number: int, item: object) -> dict[str, object]:
        """Return the initial values of the scope of a round."""
        own = {**self.userdata, self.item: item}
        return own if self.index is None else {**own, self.index: number}

    def _collect(self, inner: Scope, scope: Scope, path: str, execution: Execution) -> None:
        for key, target in self.collect.items():
            with execution.counted():
                value = inner.read(key, reader=self.position)
            if execution.append(path, scope, target, value) > MAX_COLLECTED:
                message = f"`collect` has more than {MAX_COLLECTED:,} values for {target!r}"
                raise UserdataError(message, where=self.position, hint="collect fewer values, or write them in a state")

"""The foreach container: its child once for each item of a list, or a number of times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import cast

from engine.document.count import whole_number
from engine.document.expression import Template
from engine.document.node_spec import FOREACH_OUTCOMES
from engine.errors import StateError, UserdataError
from engine.event import Cause, TransitionTaken
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
    """Rounds over what `items` evaluates to: a list, or with `counted` a number of rounds."""

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
        """The child that is run in each round."""
        return {"child": self.child}

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """All done, or not."""
        return FOREACH_OUTCOMES

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Coming to the end is what it is for."""
        return frozenset((EXHAUSTED,))

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Nothing: each round has a scope of its own."""
        return {}

    @property
    def constant(self) -> None:
        """That depends on userdata."""
        return None

    def enter(self, scope: Scope) -> NodeEntry:
        """Evaluate the items once, for all rounds."""
        value = self.items.evaluate({name: scope.read(name, reader=self.position) for name in self.items.names})
        if self.counted:
            times = whole_number(value)
            if times is None:
                raise StateError(
                    f"`times` gave {value!r}", where=self.position, hint="it must be a whole number, 0 or more"
                )
            self._require_few(times, MAX_TIMES)
            shown: dict[str, object] = {_TIMES: times}
        elif isinstance(value, list | tuple):
            items = list(cast("list[object]", value))
            self._require_few(len(items), MAX_ITEMS)
            shown = {_ITEMS: items}
        else:
            kind = type(value).__name__
            raise StateError(f"`items` gave a {kind}", where=self.position, hint="it must be a list")
        return NodeEntry(None, shown, shown)

    def _require_few(self, rounds: int, most: int) -> None:
        if rounds > most:
            message = f"{rounds:,} rounds, and at most {most:,} are allowed"
            raise StateError(message, where=self.position, hint="nest two, or lead a machine back to its begin")

    @staticmethod
    def items_of(inputs: Mapping[str, object]) -> Sequence[object]:
        """Return the item of each round of a loop that was entered with these inputs."""
        times = inputs.get(_TIMES)
        return range(times) if isinstance(times, int) else cast("list[object]", inputs.get(_ITEMS, []))

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Run the child in round after round, each in a scope of its own."""
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
            inner = Scope(f"{path}#{number}", own, scope)
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
        nothing = Cause(message="there was nothing to go through", where=path)
        return ContainerOutcome(EXHAUSTED, reason=diagnosis.reason if len(items) else nothing)

    def round_values(self, number: int, item: object) -> dict[str, object]:
        """Return the values that the scope of a round begins with."""
        own = {**self.userdata, self.item: item}
        return own if self.index is None else {**own, self.index: number}

    def _collect(self, inner: Scope, scope: Scope, path: str, execution: Execution) -> None:
        for key, target in self.collect.items():
            with execution.counted():
                value = inner.read(key, reader=self.position)
            if execution.append(path, scope, target, value) > MAX_COLLECTED:
                message = f"`collect` has more than {MAX_COLLECTED:,} values for {target!r}"
                raise UserdataError(message, where=self.position, hint="keep what is needed in a state")

"""A condition of a concurrency container: required outcomes of children, their number, and the consequence."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, cast

import msgspec
from msgspec import Meta

from engine.document.nodes.node_kind import Count, NodeName, OutcomeName

AT_LEAST = "at_least"
"""Key among the children of a condition, with a number instead of an outcome."""
PREEMPT, WHEN = "preempt", "when"
"""The two keys of a condition that preempts children instead of deciding an outcome."""


ConditionEntry = Annotated[
    dict[
        OutcomeName,
        Annotated[dict[str, str | Count], Meta(min_length=1, description="`{child: outcome}`")]
        | Annotated[tuple[NodeName, ...], Meta(min_length=1, description="For `preempt`: children")],
    ],
    Meta(
        min_length=1,
        max_length=2,
        description="`{outcome: {child: outcome, …, at_least: number}}`, or "
        "`{preempt: [child, …], when: {child: outcome, …, at_least: number}}`",
    ),
]
"""A condition as documents write it."""


class ConcurrencyCondition(msgspec.Struct, frozen=True, kw_only=True):
    """Holds when the children in `when` have ended with the outcome named for each: all, or any `at_least` of them.

    It decides the `outcome` of the container, or has an empty `outcome` and preempts the children in `preempt`.
    """

    outcome: str = ""
    when: Mapping[str, str]
    at_least: int | None = None
    preempt: tuple[str, ...] = ()

    @property
    def decides(self) -> bool:
        """Whether it ends the container."""
        return not self.preempt

    @property
    def needed(self) -> int:
        """Required number of children that have ended with the named outcome."""
        return len(self.when) if self.at_least is None else self.at_least

    @property
    def needs_all(self) -> bool:
        """Whether it requires all children."""
        return self.needed == len(self.when)

    @property
    def consequence(self) -> str:
        """The consequence as text: the outcome, or `preempt a, b`."""
        return self.outcome if self.decides else f"{PREEMPT} {', '.join(self.preempt)}"

    @property
    def text(self) -> str:
        """The condition as text, its identifier in a run."""
        return f"{self.consequence} when {self}"

    def holds(self, has_ended: Callable[[str, str], bool]) -> bool:
        """Return whether enough children have ended as required; `has_ended` takes a child and an outcome."""
        return sum(has_ended(name, due) for name, due in self.when.items()) >= self.needed

    def asks_only_for(self, is_meant: Callable[[str, str], bool]) -> bool:
        """Return whether `is_meant` is true for each required child and outcome."""
        return all(is_meant(name, due) for name, due in self.when.items())

    def __str__(self) -> str:
        """Return the required outcomes as text."""
        if self.needs_all:
            return " and ".join(f"{name}={due}" for name, due in self.when.items())
        return f"{self.needed} of " + ", ".join(f"{name}={due}" for name, due in self.when.items())


def deciding(conditions: Iterable[ConcurrencyCondition]) -> tuple[ConcurrencyCondition, ...]:
    """Return the conditions that decide the outcome, in order of precedence."""
    return tuple(condition for condition in conditions if condition.decides)


def preempting(conditions: Iterable[ConcurrencyCondition]) -> tuple[ConcurrencyCondition, ...]:
    """Return the conditions that preempt some children, in order."""
    return tuple(condition for condition in conditions if not condition.decides)


def preemptable(conditions: Iterable[ConcurrencyCondition]) -> frozenset[str]:
    """Return the names of the children that some condition preempts."""
    return frozenset(name for condition in conditions for name in condition.preempt)


def read_entry(entry: Mapping[str, object]) -> ConcurrencyCondition | None:
    """Return the condition in a document entry; None if the entry is not a condition.

    `{outcome: {child: outcome, …}}` decides, `{preempt: [child, …], when: {child: outcome, …}}` preempts.
    """
    preempted, when = entry.get(PREEMPT), entry.get(WHEN)
    if isinstance(preempted, list | tuple):
        # An outcome may also have this name; its value is a mapping.
        if not isinstance(when, dict) or len(entry) != 2:
            return None
        named = cast("list[object] | tuple[object, ...]", preempted)
        children = tuple(name for name in named if isinstance(name, str))
        return _read(cast("dict[str, object]", when), preempt=children) if children else None
    if len(entry) != 1:
        return None
    outcome, when = next(iter(entry.items()))
    return _read(cast("dict[str, object]", when), outcome=outcome) if isinstance(when, dict) else None


def _read(written: Mapping[str, object], *, outcome: str = "", preempt: tuple[str, ...] = ()) -> ConcurrencyCondition:
    # A child may also have this name; its value is text.
    count = written.get(AT_LEAST)
    when = {name: due for name, due in written.items() if isinstance(due, str)}
    return ConcurrencyCondition(
        outcome=outcome, when=when, at_least=count if isinstance(count, int) else None, preempt=preempt
    )

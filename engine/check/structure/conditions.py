"""Checks the conditions of concurrency containers: names, and that every combination is covered."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.document.nodes.concurrency_condition import (
    PREEMPT,
    WHEN,
    ConcurrencyCondition,
    deciding,
    preemptable,
    preempting,
)
from engine.wording.suggestions import did_you_mean

MAX_STEPS = 20_000
_SHOWN = 3
_PREEMPTED = ""


def check_conditions(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find unknown children and outcomes, children that cannot be preempted, and uncovered combinations."""
    for placed in subject.due:
        if placed.node.concurrency is not None:
            names = list(_check_names(subject, placed))
            yield from names
            if not names and placed.node.concurrency.otherwise is None:
                yield from _check_coverage(subject, placed)


def _check_names(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    container = placed.node.concurrency
    children = placed.node.children
    for index, rule in enumerate(container.rules if container else ()):
        for name, outcome in rule.when.items():
            keys = ("concurrency", "conditions", index, rule.outcome or WHEN, name)
            if name not in children:
                hint = did_you_mean(name, children)
                message = f"there is no child `{name}` here"
                yield subject.finding("unknown-child", message, placed.path, *keys, hint=hint, at_key=True)
                continue
            outcomes = subject.outcomes.get(f"{placed.path}/{name}")
            if outcomes is not None and outcome not in outcomes and not children[name].is_disabled:
                hint = did_you_mean(outcome, outcomes)
                message = f"`{name}` has no outcome `{outcome}`"
                yield subject.finding("unknown-outcome", message, placed.path, *keys, hint=hint)
        for place, name in enumerate(rule.preempt):
            keys = ("concurrency", "conditions", index, PREEMPT, place)
            if name not in children:
                hint = did_you_mean(name, children)
                yield subject.finding(
                    "unknown-child", f"there is no child `{name}` here", placed.path, *keys, hint=hint
                )
            elif name in rule.when and rule.needs_all:
                message = f"this condition preempts `{name}`, which has already ended when it holds"
                hint = "name children that may still be active; with `at_least`, a required child may be preempted"
                yield subject.finding("preempts-itself", message, placed.path, *keys, hint=hint)


def _check_coverage(subject: AnalyzedBehavior, placed: NodeAt) -> Iterator[Finding]:
    container = placed.node.concurrency
    outcomes = {child.name: subject.possible(child) for child in subject.children(placed)}
    known = {name: found for name, found in outcomes.items() if found is not None}
    # With a child that never ends and is not preempted, the children never all end.
    if container is None or len(known) < len(outcomes):
        return
    preempted = preemptable(container.rules)
    if any(not found and name not in preempted for name, found in known.items()):
        return
    search = _Search(deciding(container.rules), preempting(container.rules), known)
    uncovered = list(itertools.islice(search.uncovered(), _SHOWN))
    where = (placed.path, "concurrency", "conditions")
    for combination in uncovered:
        shown = ", ".join(f"{name}: {outcome or 'preempted'}" for name, outcome in combination.items())
        hint = "add a condition for it, or `otherwise: OUTCOME`"
        message = f"no condition holds when all children have ended with {shown}"
        yield subject.finding("uncovered-combination", message, *where, hint=hint, at_key=True)
    if search.exhausted and not uncovered:
        message = f"not all combinations were checked: more than {MAX_STEPS} steps"
        yield subject.finding("combinations-not-checked", message, *where, hint="add `otherwise`", at_key=True)


class _Open(NamedTuple):
    """A rule that may still hold: how many of its undecided children must still end as it requires."""

    when: Mapping[str, str]
    needed: int
    undecided: int


@dataclass
class _Search:
    """Searches for combinations of child outcomes that satisfy no condition.

    Only outcomes that conditions name matter, so the choices of each child are those and one other that
    represents the rest. Partial combinations that satisfy a condition are left out. A child that a condition may
    preempt can also end with the outcome `_PREEMPTED`, where that condition holds.
    """

    rules: Sequence[ConcurrencyCondition]
    preempting: Sequence[ConcurrencyCondition]
    outcomes: Mapping[str, tuple[str, ...]]
    steps: int = 0
    exhausted: bool = False
    _covered: set[tuple[int, tuple[tuple[int, int], ...], tuple[tuple[str, str], ...]]] = field(
        default_factory=set[Any]
    )

    def uncovered(self) -> Iterator[dict[str, str]]:
        """Yield uncovered combinations until the search ends or exceeds `MAX_STEPS`."""
        named: dict[str, set[str]] = {}
        for rule in (*self.rules, *self.preempting):
            for name, outcome in rule.when.items():
                named.setdefault(name, set()).add(outcome)
        for name in [name for rule in self.preempting for name in rule.preempt]:
            named.setdefault(name, set()).add(_PREEMPTED)
        choices = {name: self._distinct(all_of, named.get(name, set())) for name, all_of in self.outcomes.items()}
        # Children named by the most conditions are the most selective: they are tried first.
        order = sorted(named, key=lambda name: -sum(name in rule.when for rule in self.rules))
        open_rules = [_Open(rule.when, rule.needed, len(rule.when)) for rule in self.rules]
        for chosen in self._extend({}, order, choices, open_rules):
            yield {name: chosen.get(name, choices[name][0]) for name in self.outcomes}

    def _distinct(self, outcomes: tuple[str, ...], named: set[str]) -> tuple[str, ...]:
        rest = [outcome for outcome in outcomes if outcome not in named]
        preempted = (_PREEMPTED,) if _PREEMPTED in named else ()
        return (*(outcome for outcome in outcomes if outcome in named), *rest[:1], *preempted)

    def _extend(
        self,
        chosen: dict[str, str],
        order: list[str],
        choices: Mapping[str, tuple[str, ...]],
        open_rules: Sequence[_Open],
    ) -> Iterator[dict[str, str]]:
        self.steps += 1
        if self.steps > MAX_STEPS:
            self.exhausted = True
            return
        if not order or not (open_rules or self.preempting):
            if self._can_happen(chosen):
                yield dict(chosen)
            return
        # Counting conditions depend only on how many children have ended so; preemption depends on which.
        decided = tuple(chosen.items()) if self.preempting else ()
        left = (len(order), tuple((id(rule.when), rule.needed) for rule in open_rules), decided)
        if left in self._covered:
            return
        is_covered = True
        name, rest = order[0], order[1:]
        for outcome in choices[name]:
            still_open = _still_open(open_rules, name, outcome)
            if still_open is not None:
                for combination in self._extend({**chosen, name: outcome}, rest, choices, still_open):
                    is_covered = False
                    yield combination
        if is_covered and not self.exhausted:
            self._covered.add(left)

    def _can_happen(self, chosen: Mapping[str, str]) -> bool:
        """Return whether a condition that holds preempts each preempted child."""

        def ended_so(name: str, due: str) -> bool:
            return chosen.get(name) == due

        return all(
            any(name in rule.preempt and rule.holds(ended_so) for rule in self.preempting)
            for name, outcome in chosen.items()
            if outcome == _PREEMPTED
        )


def _still_open(rules: Sequence[_Open], name: str, outcome: str) -> list[_Open] | None:
    """Return the rules that can still hold after a child has ended with `outcome`; None if one holds."""
    still_open: list[_Open] = []
    for rule in rules:
        expected = rule.when.get(name)
        if expected is None:
            still_open.append(rule)
            continue
        needed = rule.needed - (expected == outcome)
        if needed == 0:
            return None
        if needed < rule.undecided:
            still_open.append(_Open(rule.when, needed, rule.undecided - 1))
    return still_open

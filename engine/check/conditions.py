"""Checks the conditions of concurrency containers: names, and that every combination is covered."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from engine.check.finding import Finding
from engine.check.subject import Placed, Subject
from engine.document.node import Condition
from engine.nearness import near_names

MAX_STEPS = 20_000
_SHOWN = 3


def check_conditions(subject: Subject) -> Iterator[Finding]:
    """Find unknown children and outcomes in conditions, and combinations that no condition covers."""
    for placed in subject.nodes.values():
        if placed.node.concurrency is not None:
            names = list(_check_names(subject, placed))
            yield from names
            if not names and placed.node.concurrency.otherwise is None:
                yield from _check_coverage(subject, placed)


def _check_names(subject: Subject, placed: Placed) -> Iterator[Finding]:
    container = placed.node.concurrency
    children = placed.node.children
    for index, rule in enumerate(container.rules if container else ()):
        for name, outcome in rule.when.items():
            keys = ("concurrency", "conditions", index, rule.outcome, name)
            if name not in children:
                hint = near_names(name, children)
                message = f"there is no child `{name}` here"
                yield subject.finding("unknown-child", message, placed.path, *keys, hint=hint, at_key=True)
                continue
            outcomes = subject.outcomes.get(f"{placed.path}/{name}")
            if outcomes is not None and outcome not in outcomes:
                hint = near_names(outcome, outcomes)
                message = f"`{name}` has no outcome `{outcome}`"
                yield subject.finding("unknown-outcome", message, placed.path, *keys, hint=hint)


def _check_coverage(subject: Subject, placed: Placed) -> Iterator[Finding]:
    container = placed.node.concurrency
    outcomes = {child.name: subject.possible(child) for child in subject.children(placed)}
    known = {name: found for name, found in outcomes.items() if found is not None}
    # With a child that never ends, the moment when all have finished never comes.
    if container is None or len(known) < len(outcomes) or not all(known.values()):
        return
    search = _Search(container.rules, known)
    uncovered = list(itertools.islice(search.uncovered(), _SHOWN))
    where = (placed.path, "concurrency", "conditions")
    for combination in uncovered:
        shown = ", ".join(f"{name}: {outcome}" for name, outcome in combination.items())
        hint = "add a condition for it, or `otherwise: OUTCOME`"
        message = f"no condition holds when all children have finished with {shown}"
        yield subject.finding("uncovered-combination", message, *where, hint=hint, at_key=True)
    if search.exhausted and not uncovered:
        message = f"not all combinations were checked: more than {MAX_STEPS} steps"
        yield subject.finding("combinations-not-checked", message, *where, hint="add `otherwise`", at_key=True)


@dataclass
class _Search:
    """Looks for combinations of child outcomes that satisfy no condition.

    Only outcomes that conditions name can matter, so each child has those, and one other that
    stands for the rest. Partial combinations that satisfy a condition are not followed further.
    """

    rules: Sequence[Condition]
    outcomes: Mapping[str, tuple[str, ...]]
    steps: int = 0
    exhausted: bool = False

    def uncovered(self) -> Iterator[dict[str, str]]:
        """Go through uncovered combinations until the search is over or takes too long."""
        named: dict[str, set[str]] = {}
        for rule in self.rules:
            for name, outcome in rule.when.items():
                named.setdefault(name, set()).add(outcome)
        choices = {name: self._distinct(all_of, named.get(name, set())) for name, all_of in self.outcomes.items()}
        # The children that most conditions name decide most, so they are tried first.
        order = sorted(named, key=lambda name: -sum(name in rule.when for rule in self.rules))
        for chosen in self._extend({}, order, choices, [(rule.when, len(rule.when)) for rule in self.rules]):
            yield {name: chosen.get(name, choices[name][0]) for name in self.outcomes}

    def _distinct(self, outcomes: tuple[str, ...], named: set[str]) -> tuple[str, ...]:
        rest = [outcome for outcome in outcomes if outcome not in named]
        return (*(outcome for outcome in outcomes if outcome in named), *rest[:1])

    def _extend(
        self,
        chosen: dict[str, str],
        order: list[str],
        choices: Mapping[str, tuple[str, ...]],
        open_rules: Sequence[tuple[Mapping[str, str], int]],
    ) -> Iterator[dict[str, str]]:
        self.steps += 1
        if self.steps > MAX_STEPS:
            self.exhausted = True
            return
        if not open_rules or not order:
            yield dict(chosen)
            return
        name, rest = order[0], order[1:]
        for outcome in choices[name]:
            still_open = _still_open(open_rules, name, outcome)
            if still_open is not None:
                yield from self._extend({**chosen, name: outcome}, rest, choices, still_open)


def _still_open(
    rules: Sequence[tuple[Mapping[str, str], int]], name: str, outcome: str
) -> list[tuple[Mapping[str, str], int]] | None:
    """Return the rules that a child's outcome leaves open, with how many children each waits for; None if one holds."""
    still_open: list[tuple[Mapping[str, str], int]] = []
    for when, waiting in rules:
        wanted = when.get(name)
        if wanted is None or wanted == outcome:
            waiting -= wanted is not None
            if waiting == 0:
                return None
            still_open.append((when, waiting))
    return still_open

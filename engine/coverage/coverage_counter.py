"""Counts the covered items of one run from the changes of its state."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from engine.coverage.coverage_item import Key
from engine.coverage.inventory import CoverageInventory
from engine.event import Event
from engine.runtime.history.run_reducer import DIVERTED_TO_OUTCOME, RunReducer
from engine.runtime.history.run_state import NodeStep, RunStateChange


class CoverageCounter:
    """Counts one run; pass its events to `take` in order.

    Args:
        inventory: The items that can be counted.
        counts: Count of each item, by key; counts are increased, keys never added.
        watch: Called with each change of the state of the run, for those who would reduce the same events again.
    """

    def __init__(
        self,
        inventory: CoverageInventory,
        counts: dict[Key, int],
        *,
        watch: Callable[[RunStateChange], None] = lambda _change: None,
    ) -> None:
        self._inventory = inventory
        self._counts = counts
        self._watch = watch
        self._reducer = RunReducer()

    def take(self, event: Event) -> None:
        """Count an event; events of another version of the document do not count."""
        change = self._reducer.apply(event)
        if change is None:
            return
        self._watch(change)
        if change.step is None:
            return
        if self._reducer.state.document in ("", self._inventory.behavior.meaning):
            self._count_step(change.step)

    def _count_step(self, step: NodeStep) -> None:
        match step.kind:
            case "entered":
                self._count(("node", step.path, ""))
            case "ended" if step.name and not step.is_preempted:
                self._count_exit(step.path, step.name, step.children)
            case "transition" if step.name:
                self._count(("transition", step.path, step.name))
            case "diverted":
                self._count_diversion(step)
            case "preempts":
                rules = self._inventory.rules.get(step.path, ())
                name = next((rule.name for rule in rules if rule.condition.text == step.name), "")
                self._count(("condition", step.path, name))
            case "ticked":
                self._count_tick(step)
            case _:
                pass

    def _count_exit(self, path: str, outcome: str, children: Mapping[str, str]) -> None:
        self._count(("outcome", path, outcome))
        succeeding = self._inventory.succeeding.get(path)
        if succeeding is not None:
            self._count(("status", path, "success" if outcome in succeeding else "failure"))
        for rule in self._inventory.rules.get(path, ()):
            condition = rule.condition
            if (
                condition.decides
                and condition.outcome == outcome
                and condition.holds(lambda child, due: children.get(child) == due)
            ):
                self._count(("condition", path, rule.name))
                break

    def _count_diversion(self, step: NodeStep) -> None:
        if step.by in DIVERTED_TO_OUTCOME:
            return
        self._count((step.by, step.path, ""))
        # The target of a behavior's root is an outcome of the behavior, that of a leaf of a tree a status.
        self._count(("outcome" if step.path in self._inventory.roots else "status", step.path, step.name))

    def _count_tick(self, step: NodeStep) -> None:
        if step.path in self._inventory.succeeding:
            return  # a native leaf is entered and exited like any state
        if step.name != "invalid" and step.before.status != "active":
            self._count(("node", step.path, ""))
        if step.name in ("success", "failure"):
            self._count(("status", step.path, step.name))

    def _count(self, key: Key) -> None:
        if key in self._counts:
            self._counts[key] += 1

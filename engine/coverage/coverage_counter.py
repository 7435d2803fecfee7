"""Counts the covered items of one run from its events."""

from __future__ import annotations

from engine.coverage.coverage_item import Key
from engine.coverage.inventory import CoverageInventory
from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
    Event,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    RunStarted,
    StatusChanged,
    TransitionTaken,
)
from engine.runtime.history.run_reducer import DIVERTED_TO_OUTCOME


class CoverageCounter:
    """Counts one run; pass its events to `take` in order.

    Args:
        inventory: The items that can be counted.
        counts: Count of each item, by key; counts are increased, keys never added.
    """

    def __init__(self, inventory: CoverageInventory, counts: dict[Key, int]) -> None:
        self._inventory = inventory
        self._counts = counts
        self._ours = True
        self._finished: dict[str, dict[str, str]] = {}
        self._statuses: dict[str, str] = {}

    def take(self, event: Event) -> None:
        """Count an event; events of another version of the document do not count."""
        match event:
            case RunStarted() | BehaviorChanged():
                self._ours = event.document == self._inventory.behavior.meaning
            case _ if not self._ours:
                pass
            case NodeEntered():
                self._count(("node", event.path, ""))
                self._finished.pop(event.path, None)
            case NodeExited(preempted=False) if event.outcome:
                self._exited(event.path, event.outcome)
            case TransitionTaken() if event.outcome:
                self._count(("transition", f"{event.path}/{event.source}", event.outcome))
            case NodeDiverted():
                self._diverted(event)
            case BranchesPreempted():
                self._preempted(event)
            case NodeRetried():
                self._finish(event.path, None)
            case StatusChanged():
                self._changed(event.path, event.status)
            case _:
                pass

    def _exited(self, path: str, outcome: str) -> None:
        self._count(("outcome", path, outcome))
        self._finish(path, outcome)
        succeeding = self._inventory.succeeding.get(path)
        if succeeding is not None:
            self._count(("status", path, "success" if outcome in succeeding else "failure"))
        finished = self._finished.get(path, {})
        for rule in self._inventory.rules.get(path, ()):
            condition = rule.condition
            if (
                condition.decides
                and condition.outcome == outcome
                and condition.holds(lambda child, due: finished.get(child) == due)
            ):
                self._count(("condition", path, rule.name))
                break

    def _preempted(self, event: BranchesPreempted) -> None:
        rules = self._inventory.rules.get(event.path, ())
        name = next((rule.name for rule in rules if rule.condition.said == event.condition), "")
        self._count(("condition", event.path, name))

    def _diverted(self, event: NodeDiverted) -> None:
        self._finish(event.path, event.target)
        if event.by in DIVERTED_TO_OUTCOME:
            return
        self._count((event.by, event.path, ""))
        # The target of a behavior's root is an outcome of the behavior, that of a leaf of a tree a status.
        self._count(("outcome" if event.path in self._inventory.roots else "status", event.path, event.target))

    def _finish(self, path: str, outcome: str | None) -> None:
        container, _, name = path.rpartition("/")
        if outcome is None:
            self._finished.get(container, {}).pop(name, None)
        elif container in self._inventory.rules:
            self._finished.setdefault(container, {})[name] = outcome

    def _changed(self, path: str, status: str) -> None:
        if path in self._inventory.succeeding:
            return  # a native leaf is entered and exited like any state
        before = self._statuses.get(path, "invalid")
        self._statuses[path] = status
        if status != "invalid" and before != "running":
            self._count(("node", path, ""))
        if status in ("success", "failure"):
            self._count(("status", path, status))

    def _count(self, key: Key) -> None:
        if key in self._counts:
            self._counts[key] += 1

"""Which items of a behavior single runs cover, as bits that any number of runs can be joined by."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from engine.coverage.coverage_counter import CoverageCounter
from engine.coverage.coverage_item import CoverageItem, Key
from engine.coverage.inventory import CoverageInventory, take_inventory
from engine.document.behavior import Behavior
from engine.event import Event
from engine.runtime.history import RunStateChange
from engine.runtime.plan import Catalogue


class CoverageRuns:
    """The items of one behavior; `follow` begins a run.

    Args:
        behavior: The behavior.
        catalogue: The states that it uses.

    Raises:
        DocumentError: the behavior is invalid.
    """

    def __init__(self, behavior: Behavior, catalogue: Catalogue) -> None:
        self._inventory = take_inventory(behavior, catalogue)

    @property
    def items(self) -> tuple[CoverageItem, ...]:
        """All items that can be covered, in document order: the lowest bit is the first."""
        return self._inventory.items

    def follow(self, *, watch: Callable[[RunStateChange], None] = lambda _change: None) -> CoveredItems:
        """Return what a new run covers: give it the events of the run.

        Args:
            watch: Called with each change of the state of the run.
        """
        return CoveredItems(self._inventory, watch=watch)

    def missing(self, bits: Iterable[str]) -> tuple[CoverageItem, ...]:
        """Return the items that none of the runs with these bits covers."""
        covered = 0
        for each in bits:
            covered |= int(each or "0", 16)
        return tuple(item for index, item in enumerate(self.items) if not covered >> index & 1)


class CoveredItems:
    """What one run covers; pass its events to `take` in order."""

    def __init__(self, inventory: CoverageInventory, *, watch: Callable[[RunStateChange], None]) -> None:
        self._counts: dict[Key, int] = {item.key: 0 for item in inventory.items}
        self._counter = CoverageCounter(inventory, self._counts, watch=watch)

    def take(self, event: Event) -> None:
        """Count an event."""
        self._counter.take(event)

    @property
    def bits(self) -> str:
        """The covered items as hexadecimal bits, in document order from the lowest."""
        return format(sum(1 << index for index, count in enumerate(self._counts.values()) if count), "x")

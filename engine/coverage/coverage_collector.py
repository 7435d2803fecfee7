"""Collects the coverage of a behavior from the events of any number of runs."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import msgspec

from engine.coverage.coverage_counter import CoverageCounter
from engine.coverage.coverage_file import (
    BehaviorCoverage,
    CoveredDocument,
    merge,
    read_coverage,
    text_hash,
    write_coverage,
)
from engine.coverage.coverage_item import CoverageItem, Key
from engine.coverage.inventory import take_inventory
from engine.document.behavior import Behavior
from engine.errors import FlexcellError
from engine.event import Event, RunStarted
from engine.runtime.plan import Catalogue
from engine.runtime.record.recorder import Watcher


class CoverageCollector:
    """Nodes of a behavior that were entered, and exits of nodes that were taken, in a set of runs.

    Args:
        behavior: The behavior.
        catalogue: The states that it uses.

    Raises:
        DocumentError: the behavior is invalid.
    """

    def __init__(self, behavior: Behavior, catalogue: Catalogue) -> None:
        self.behavior = behavior
        self.runs = 0
        self._inventory = take_inventory(behavior, catalogue)
        self._counts: dict[Key, int] = {item.key: 0 for item in self._inventory.items}

    def follow(self) -> Watcher:
        """Count one more run and return the function that receives its events, for `Run.watch`."""
        self.runs += 1
        return CoverageCounter(self._inventory, self._counts).take

    def add(self, events: Iterable[Event]) -> None:
        """Count a run from its complete event log.

        Raises:
            FlexcellError: the log is of another behavior, or of another version of this one.
        """
        log = tuple(events)
        for event in log:
            if isinstance(event, RunStarted) and event.document != self.behavior.meaning:
                raise FlexcellError(
                    f"this is a run of {event.behavior}, document {event.document[:12]}, not of {self.behavior.name}, "
                    f"document {self.behavior.meaning[:12]}",
                    hint="run the current version of the behavior",
                )
        take = self.follow()
        for event in log:
            take(event)

    @property
    def items(self) -> tuple[CoverageItem, ...]:
        """All items that can be covered, with their counts, in document order."""
        return tuple(msgspec.structs.replace(item, count=self._counts[item.key]) for item in self._inventory.items)

    @property
    def missing(self) -> tuple[CoverageItem, ...]:
        """The items that are not covered."""
        return tuple(item for item in self.items if not item.count)

    @property
    def percent(self) -> float:
        """The covered share in percent."""
        return self.record().percent

    def record(self) -> BehaviorCoverage:
        """Return the content of a coverage file; files inside the current directory are named relative to it."""
        documents = tuple(
            CoveredDocument(file=_shown(str(one.file)), meaning=one.meaning, text=text_hash(one.file))
            for one in self._inventory.behaviors
        )
        return BehaviorCoverage(
            behavior=self.behavior.name,
            document=self.behavior.meaning,
            runs=self.runs,
            documents=documents,
            items=tuple(msgspec.structs.replace(item, file=_shown(item.file)) for item in self.items),
        )

    def require_same(self, file: Path) -> None:
        """Check that the counts can be added to a coverage file, if it exists.

        Raises:
            FlexcellError: the file cannot be used, or contains another version of the behavior.
        """
        self._added_to(file)

    def accumulate(self, file: Path) -> None:
        """Add the counts to a coverage file, which is created if missing.

        Raises:
            FlexcellError: the file cannot be used, or contains another version of the behavior.
        """
        write_coverage(file, self._added_to(file))

    def _added_to(self, file: Path) -> tuple[BehaviorCoverage, ...]:
        return merge((*(read_coverage(file) if file.exists() else ()), self.record()))


def _shown(file: str) -> str:
    path = Path(os.path.abspath(file))  # noqa: PTH100 - a link is shown as it was named
    here = Path.cwd()
    return path.relative_to(here).as_posix() if path.is_relative_to(here) else path.as_posix()

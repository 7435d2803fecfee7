"""How much of a behavior its runs have covered: feed it with the events of any number of runs."""

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
    """Which nodes of a behavior were entered, and which of their ways out were taken, in some runs.

    Args:
        behavior: What is run.
        catalogue: The states it uses.

    Raises:
        DocumentError: the behavior cannot be run.
    """

    def __init__(self, behavior: Behavior, catalogue: Catalogue) -> None:
        self.behavior = behavior
        self.runs = 0
        self._inventory = take_inventory(behavior, catalogue)
        self._counts: dict[Key, int] = {item.key: 0 for item in self._inventory.items}

    def follow(self) -> Watcher:
        """Count one more run and return what takes its events, for `Run.watch`."""
        self.runs += 1
        return CoverageCounter(self._inventory, self._counts).take

    def add(self, events: Iterable[Event]) -> None:
        """Count a run by its whole event log.

        Raises:
            FlexcellError: the log is of another behavior, or of another version of this one.
        """
        log = tuple(events)
        for event in log:
            if isinstance(event, RunStarted) and event.document != self.behavior.meaning:
                raise FlexcellError(
                    f"this is a run of {event.behavior}, document {event.document[:12]}, not of {self.behavior.name}, "
                    f"document {self.behavior.meaning[:12]}",
                    hint="run the present version of the behavior again",
                )
        take = self.follow()
        for event in log:
            take(event)

    @property
    def items(self) -> tuple[CoverageItem, ...]:
        """Everything that can be covered, with how often it was seen, in document order."""
        return tuple(msgspec.structs.replace(item, count=self._counts[item.key]) for item in self._inventory.items)

    @property
    def missing(self) -> tuple[CoverageItem, ...]:
        """What was not seen."""
        return tuple(item for item in self.items if not item.count)

    @property
    def percent(self) -> float:
        """The share that was seen."""
        return self.record().percent

    def record(self) -> BehaviorCoverage:
        """Return what a coverage file keeps; files inside the current directory are named relative to it."""
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
        """Check that what is counted can be added to a coverage file, if there is one.

        Raises:
            FlexcellError: the file cannot be used, or holds another version of the behavior.
        """
        self._added_to(file)

    def accumulate(self, file: Path) -> None:
        """Add what was counted to a coverage file, which is made where there is none.

        Raises:
            FlexcellError: the file cannot be used, or holds another version of the behavior.
        """
        write_coverage(file, self._added_to(file))

    def _added_to(self, file: Path) -> tuple[BehaviorCoverage, ...]:
        return merge((*(read_coverage(file) if file.exists() else ()), self.record()))


def _shown(file: str) -> str:
    path = Path(os.path.abspath(file))
    here = Path.cwd()
    return path.relative_to(here).as_posix() if path.is_relative_to(here) else path.as_posix()

"""The current names of the entries in the store of an open cell, for the check of behaviors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from engine.cell.open_cell import OpenCell
from engine.store import EntryChange


class StoredEntries:
    """Belongs to the event loop of its cell; `of_cell` is thread-safe."""

    def __init__(self, cell: OpenCell) -> None:
        self._cell = cell
        self._names: Mapping[str, frozenset[str]] | None = None
        self._end: Callable[[], None] = lambda: None

    async def open(self) -> None:
        """Read the names, and follow the changes until `close`; without a store there are none."""
        store = self._cell.store
        if store is None:
            return
        self._names = {}
        self._end = await store.follow(self._take)
        found: dict[str, set[str]] = {}
        for key in await store.list():
            found.setdefault(key.kind, set()).add(key.name)
        self._names = {kind: frozenset(names) for kind, names in found.items()}

    def close(self) -> None:
        """Stop following changes."""
        self._end()

    def of_cell(self, file: Path) -> Mapping[str, frozenset[str]] | None:
        """Return the current names by kind; None for the file of another cell."""
        document = self._cell.document
        return self._names if document is not None and document.file.resolve() == file.resolve() else None

    def _take(self, change: EntryChange) -> None:
        # A new mapping each time: other threads may be reading the old one.
        names = self._names or {}
        known = names.get(change.kind, frozenset())
        changed = known - {change.name} if change.value is None else known | {change.name}
        self._names = {**names, change.kind: changed}

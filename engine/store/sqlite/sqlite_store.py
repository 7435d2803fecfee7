"""The embedded store: named entries in one SQLite file, durable at every write."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from engine.store.entry_kinds import STANDARD_KINDS, EntryKind
from engine.store.sqlite.sqlite_table import SqliteTable
from engine.store.table_store import TableStore


class SqliteStore(TableStore):
    """A `Store` in a file; open it with `SqliteStore.open`, close it or use `async with`."""

    def __init__(self, table: SqliteTable, *, inline: bool, kinds: Mapping[str, EntryKind]) -> None:
        super().__init__(table, inline=inline, kinds=kinds)
        self.path = table.path

    @classmethod
    def open(
        cls,
        path: Path | str,
        *,
        inline: bool = False,
        kinds: Mapping[str, EntryKind] = STANDARD_KINDS,
        busy_timeout_s: float = 5.0,
    ) -> SqliteStore:
        """Open or create a store.

        Args:
            path: The file; missing parent directories are created.
            inline: Work on the calling thread, so that a run in virtual time stays
                deterministic; otherwise one worker thread keeps the event loop free.
            kinds: The kinds of entries.
            busy_timeout_s: Time to wait for another process that holds the file locked.

        Raises:
            StoreError: the file cannot be opened.
        """
        return cls(SqliteTable.open(Path(path), busy_timeout_s=busy_timeout_s), inline=inline, kinds=kinds)

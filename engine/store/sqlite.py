"""The embedded store: named entries in one SQLite file, durable at every write."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import TracebackType
from typing import Self, TypeVar

from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store.contract import ChangeListener, EntryChange, EntryKey, Value
from engine.store.kinds import STANDARD_KINDS, EntryKind, verified_value
from engine.store.limits import decode_value, encode_value, verify_name
from engine.store.table import EntryTable, Row

T = TypeVar("T")


class SqliteStore:
    """A `Store` in a file; open it with `SqliteStore.open`, close it or use `async with`."""

    def __init__(self, table: EntryTable, *, worker: ThreadPoolExecutor | None, kinds: Mapping[str, EntryKind]) -> None:
        self.path = table.path
        self._table = table
        self._worker = worker
        self._kinds = kinds
        self._listeners: dict[object, ChangeListener] = {}
        self._closed = False

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
            path: The file; directories above it are made.
            inline: Work on the calling thread, so that a run in virtual time stays
                deterministic; otherwise one worker thread keeps the event loop free.
            kinds: The kinds of entries it takes.
            busy_timeout_s: How long to wait for another process that holds the file locked.

        Raises:
            StoreError: the file cannot be opened.
        """
        table = EntryTable.open(Path(path), busy_timeout_s=busy_timeout_s)
        worker = None if inline else ThreadPoolExecutor(max_workers=1, thread_name_prefix="store")
        return cls(table, worker=worker, kinds=kinds)

    async def get(self, kind: str, name: str) -> EntryRecord:
        """Return an entry; raises EntryNotFound with the near names."""
        verify_name(kind, name)
        return await self._do(lambda: _record(self._table.get(kind, name)))

    async def put(self, kind: str, name: str, value: Value, *, expected_revision: int | None = None) -> EntryRecord:
        """Write an entry durably; raises StoreError when refused or when another revision is there."""

        def write() -> tuple[Row, ...]:
            data = self._checked(kind, name, value)
            return (self._table.put(kind, name, data, expected_revision=expected_revision),)

        return _record((await self._change(write))[0])

    async def list(self, *, kind: str = "", prefix: str = "") -> tuple[EntryKey, ...]:
        """Return the entries of a kind (of all when empty) whose name begins with `prefix`, sorted."""
        return await self._do(lambda: tuple(map(_key, self._table.select(kind, prefix, values=False))))

    async def delete(self, kind: str, name: str, *, expected_revision: int | None = None) -> None:
        """Remove an entry; its history stays."""
        verify_name(kind, name)
        await self._change(lambda: (self._table.delete(kind, name, expected_revision=expected_revision),))

    async def history(self, kind: str, name: str) -> tuple[EntryChange, ...]:
        """Return every change of an entry, oldest first."""
        return await self._do(lambda: tuple(map(_changed, self._table.changes(kind, name))))

    async def export(self, *, kind: str = "", prefix: str = "") -> tuple[EntryRecord, ...]:
        """Return entries with their values, sorted by kind and name."""
        return await self._do(lambda: tuple(map(_record, self._table.select(kind, prefix, values=True))))

    async def seed(self, entries: Iterable[EntryRecord], *, overwrite: bool = False) -> tuple[EntryKey, ...]:
        """Write the entries that are missing (with `overwrite` also those that differ), all or none."""
        given = tuple(entries)

        def write() -> tuple[Row, ...]:
            checked = [(e.kind, e.name, self._checked(e.kind, e.name, e.value)) for e in given]
            return self._table.seed(checked, overwrite=overwrite)

        return tuple(map(_key, await self._change(write)))

    def watch(self, listener: ChangeListener) -> Callable[[], None]:
        """Call `listener` on the event loop after each change committed through this store."""
        token = object()
        self._listeners[token] = listener

        def end() -> None:
            self._listeners.pop(token, None)

        return end

    async def close(self) -> None:
        """Finish what is under way and release the file; may be called again."""
        if self._closed:
            return
        self._closed = True
        if self._worker is not None:
            await asyncio.get_running_loop().run_in_executor(self._worker, self._table.close)
            self._worker.shutdown()
        else:
            self._table.close()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    def _checked(self, kind: str, name: str, value: Value) -> str:
        verify_name(kind, name)
        where = f"{kind} {name}"
        return encode_value(verified_value(self._kinds, kind, value, where=where), where=where)

    async def _do(self, work: Callable[[], T]) -> T:
        if self._closed:
            raise StoreError("the store is closed", where=self.path, hint="open it again")
        if self._worker is None:
            return work()
        return await asyncio.get_running_loop().run_in_executor(self._worker, work)

    async def _change(self, work: Callable[[], tuple[Row, ...]]) -> tuple[Row, ...]:
        loop = asyncio.get_running_loop()

        def work_and_tell() -> tuple[Row, ...]:
            rows = work()
            # Told from here, so that a caller cancelled in the meantime does not hide the change.
            loop.call_soon_threadsafe(self._tell, rows)
            return rows

        if self._worker is not None:
            return await self._do(work_and_tell)
        rows = await self._do(work)
        self._tell(rows)
        return rows

    def _tell(self, rows: tuple[Row, ...]) -> None:
        for row in rows:
            for listener in tuple(self._listeners.values()):
                listener(_changed(row))


def _record(row: Row) -> EntryRecord:
    return EntryRecord(kind=row.kind, name=row.name, value=decode_value(row.value or "{}"), revision=row.revision)


def _key(row: Row) -> EntryKey:
    return EntryKey(kind=row.kind, name=row.name, revision=row.revision)


def _changed(row: Row) -> EntryChange:
    value = None if row.value is None else decode_value(row.value)
    return EntryChange(kind=row.kind, name=row.name, revision=row.revision, value=value)

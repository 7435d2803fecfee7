"""A store over the table of any database: validates values, works off the event loop, notifies its listeners."""

from __future__ import annotations

import asyncio
import time
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from types import TracebackType
from typing import Self, TypeVar

from engine.errors import StoreError
from engine.skills.entries import EntryRecord
from engine.store.change_feed import ChangeFeed
from engine.store.contract import ChangeListener, EntryChange, EntryKey, Value
from engine.store.entry_kinds import EntryKind, verified_value
from engine.store.limits import encode_value, is_name_start, verify_name, verify_note, verify_tags
from engine.store.row_mapping import change_of, exported_of, key_of, record_of, row_from
from engine.store.rows import ChangeStamp, EntryDraft, EntryQuery, RevisionRow
from engine.store.search_terms import query_terms
from engine.store.table import EntryTable

T = TypeVar("T")


class TableStore:
    """The `Store` implementation common to all databases; one worker thread, or none when `inline`."""

    def __init__(self, table: EntryTable, *, inline: bool, kinds: Mapping[str, EntryKind]) -> None:
        self._table = table
        self._worker = None if inline else ThreadPoolExecutor(max_workers=1, thread_name_prefix="store")
        self._kinds = kinds
        self._listeners: dict[object, ChangeListener] = {}
        self._writer = uuid.uuid4().hex
        self._change_feed: ChangeFeed | None = None
        self._closed = False

    @property
    def address(self) -> str:
        """The location of the entries, without secrets."""
        return self._table.address

    async def get(self, kind: str, name: str) -> EntryRecord:
        """Return an entry; raises EntryNotFound with similar names."""
        verify_name(kind, name)
        return await self._do(lambda: record_of(self._table.get(kind, name)))

    async def put(
        self,
        kind: str,
        name: str,
        value: Value,
        *,
        expected_revision: int | None = None,
        tags: Iterable[str] | None = None,
        by: str = "",
        reason: str = "",
    ) -> EntryRecord:
        """Write an entry durably; raises StoreError when refused or when another revision is stored."""
        stamp = self._stamp(f"{kind} {name}", by, reason)

        def write() -> tuple[RevisionRow, ...]:
            draft = self._draft(kind, name, value, tags)
            return (self._table.put(draft, stamp, expected_revision=expected_revision),)

        return record_of((await self._change(write))[0])

    async def list(
        self,
        *,
        kind: str = "",
        prefix: str = "",
        tags: Iterable[str] = (),
        text: str = "",
        after: EntryKey | None = None,
        limit: int | None = None,
    ) -> tuple[EntryKey, ...]:
        """Return the entries that meet all conditions, sorted by kind and name."""
        selection = EntryQuery(
            kind=kind,
            prefix=prefix,
            tags=tuple(tags),
            words=query_terms(text),
            after=None if after is None else (after.kind, after.name),
            limit=limit,
        )
        has_no_match = not is_name_start(prefix) or (text.strip() != "" and not selection.words)
        if has_no_match:
            return ()
        return await self._do(lambda: tuple(map(key_of, self._table.select(selection, values=False))))

    async def delete(
        self, kind: str, name: str, *, expected_revision: int | None = None, by: str = "", reason: str = ""
    ) -> None:
        """Delete an entry; its history is kept."""
        verify_name(kind, name)
        stamp = self._stamp(f"{kind} {name}", by, reason)
        await self._change(lambda: (self._table.delete(kind, name, stamp, expected_revision=expected_revision),))

    async def undo(
        self, kind: str, name: str, *, expected_revision: int | None = None, by: str = "", reason: str = ""
    ) -> EntryChange:
        """Restore the entry before its last change, as a new revision."""
        verify_name(kind, name)
        stamp = self._stamp(f"{kind} {name}", by, reason)
        rows = await self._change(lambda: (self._table.undo(kind, name, stamp, expected_revision=expected_revision),))
        return change_of(rows[0])

    async def history(self, kind: str, name: str) -> tuple[EntryChange, ...]:
        """Return every change of an entry, oldest first."""
        verify_name(kind, name)
        return await self._do(lambda: tuple(map(change_of, self._table.changes(kind, name))))

    async def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry, including deleted ones, sorted."""
        return await self._do(self._table.all_names)

    async def export(self, *, kind: str = "", prefix: str = "") -> tuple[EntryRecord, ...]:
        """Return entries with their values and tags, sorted by kind and name."""
        selection = EntryQuery(kind=kind, prefix=prefix)
        return await self._do(lambda: tuple(map(exported_of, self._table.select(selection, values=True))))

    async def seed(
        self, entries: Iterable[EntryRecord], *, overwrite: bool = False, by: str = "", reason: str = ""
    ) -> tuple[EntryKey, ...]:
        """Write the missing entries (with `overwrite` also those that differ), all or none."""
        records = tuple(entries)
        stamp = self._stamp("seed", by, reason)

        def write() -> tuple[RevisionRow, ...]:
            drafts = [self._draft(entry.kind, entry.name, entry.value, entry.tags) for entry in records]
            return self._table.seed(drafts, stamp, overwrite=overwrite)

        return tuple(map(key_of, await self._change(write)))

    async def import_histories(self, histories: Iterable[Sequence[EntryChange]]) -> int:
        """Import entries with their whole histories; raises EntryConflict for an entry with another history."""
        all_histories = tuple(histories)

        def write() -> tuple[RevisionRow, ...]:
            return self._table.import_histories(
                [[self._imported_row(change) for change in history] for history in all_histories]
            )

        return len(await self._change(write))

    def watch(self, listener: ChangeListener) -> Callable[[], None]:
        """Call `listener` on the event loop after each change committed through this store."""
        token = object()
        self._listeners[token] = listener

        def unwatch() -> None:
            self._listeners.pop(token, None)

        return unwatch

    async def follow(self, listener: ChangeListener) -> Callable[[], None]:
        """Watch, and also receive the changes of other programs."""
        unwatch = self.watch(listener)
        if self._worker is None:
            return unwatch
        if self._change_feed is None:
            feed = await self._do(self._table.feed)
            if feed is None:
                return unwatch
            self._change_feed = ChangeFeed(feed, writer=self._writer, loop=asyncio.get_running_loop())
            self._change_feed.start()
        unsubscribe = self._change_feed.subscribe(listener)

        def unfollow() -> None:
            unwatch()
            unsubscribe()

        return unfollow

    async def close(self) -> None:
        """Finish active operations and close the database; may be called again."""
        if self._closed:
            return
        self._closed = True
        if self._change_feed is not None:
            await asyncio.get_running_loop().run_in_executor(None, self._change_feed.stop)
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

    def _draft(self, kind: str, name: str, value: Value, tags: Iterable[str] | None) -> EntryDraft:
        verify_name(kind, name)
        where = f"{kind} {name}"
        encoded = encode_value(verified_value(self._kinds, kind, value, where=where), where=where)
        return EntryDraft(
            kind=kind, name=name, value=encoded, tags=None if tags is None else verify_tags(tags, where=where)
        )

    def _stamp(self, where: str, by: str, reason: str) -> ChangeStamp:
        verify_note(by, reason, where=where)
        return ChangeStamp(by=by, reason=reason, changed_unix_ms=time.time_ns() // 1_000_000, writer=self._writer)

    def _imported_row(self, change: EntryChange) -> RevisionRow:
        verify_name(change.kind, change.name)
        where = f"{change.kind} {change.name}"
        verify_tags(change.tags, where=where)
        verify_note(change.by, change.reason, where=where)
        # Values of earlier revisions are not validated: the kind may have been different, or unknown, then.
        value = None if change.value is None else encode_value(change.value, where=where)
        return row_from(change, value, writer=self._writer)

    async def _do(self, work: Callable[[], T]) -> T:
        if self._closed:
            raise StoreError("the store is closed", where=self.address, hint="open it again")
        if self._worker is None:
            return work()
        return await asyncio.get_running_loop().run_in_executor(self._worker, work)

    async def _change(self, work: Callable[[], tuple[RevisionRow, ...]]) -> tuple[RevisionRow, ...]:
        loop = asyncio.get_running_loop()

        def work_and_notify() -> tuple[RevisionRow, ...]:
            rows = work()
            # Notified from here, so that a change of a caller cancelled meanwhile is reported too.
            loop.call_soon_threadsafe(self._notify, rows)
            return rows

        if self._worker is not None:
            return await self._do(work_and_notify)
        rows = await self._do(work)
        self._notify(rows)
        return rows

    def _notify(self, rows: tuple[RevisionRow, ...]) -> None:
        for row in rows:
            for listener in tuple(self._listeners.values()):
                listener(change_of(row))

"""Entries in a MongoDB database: the blocking operations on its two collections.

The collection `change` is authoritative: the writer that inserts the document of a revision has made
that revision, since ids are unique. The collection `entry` has the last revision of each entry and is
updated directly afterwards; if a writer dies in between, the next writer updates it. So a change of
one entry needs no transaction and also works on a server without a replica set.
"""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import pymongo
from pymongo import IndexModel
from pymongo.client_session import ClientSession
from pymongo.collection import Collection
from pymongo.errors import BulkWriteError, DuplicateKeyError, PyMongoError

from engine.errors import EntryNotFound
from engine.store.mongo.mongo_documents import (
    Document,
    change_document,
    change_id,
    entry_document,
    entry_id,
    row_from_document,
)
from engine.store.mongo.mongo_errors import is_retryable, translate_mongo_errors
from engine.store.mongo.mongo_feed import MongoChangePoller, MongoChangeStream
from engine.store.mongo.mongo_server import MongoServer
from engine.store.rows import ChangeStamp, EntryDraft, EntryQuery, RevisionRow, deletion_row, needs_seeding, next_row
from engine.store.search_terms import AFTER_PREFIX, MAX_PREFIX, tag_term
from engine.store.table import ChangeSource, entry_not_found, missing_revisions, verify_revision
from engine.store.undo_chain import undo_row

T = TypeVar("T")
_NO_VALUES = {"value": 0, "value_json": 0}
_DUPLICATE_KEY = 11000
_NEAR = 1000
_MANY_S = 120.0
"""Time limit of an operation on many entries."""


class MongoTable:
    """Entries on a MongoDB server; used by one thread at a time, each feed by its own thread."""

    def __init__(self, server: MongoServer, *, patience_s: float) -> None:
        self._server = server
        self._patience_s = patience_s
        self._entries: Collection[Document] = server.database["entry"]
        self._changes: Collection[Document] = server.database["change"]

    @property
    def address(self) -> str:
        """Server and database, without secrets."""
        return self._server.address

    def prepare(self) -> None:
        """Create missing indexes."""

        def work() -> None:
            keys = (["kind", "name"], ["name", "kind"], ["starts", "kind", "name"])
            self._entries.create_indexes([IndexModel(each) for each in keys])
            self._changes.create_indexes([IndexModel(["kind", "name", "revision"], unique=True), IndexModel("changed")])

        self._with_retries(work, writing=True, limit_s=_MANY_S)

    def get(self, kind: str, name: str) -> RevisionRow:
        """Return an entry or raise EntryNotFound with similar names."""
        return self._with_retries(lambda: self._found(kind, name))

    def select(self, selection: EntryQuery, *, values: bool) -> tuple[RevisionRow, ...]:
        """Return entries sorted by kind and name, with their values if `values`."""

        def work() -> tuple[RevisionRow, ...]:
            cursor = self._entries.find(_filter(selection), None if values else _NO_VALUES)
            cursor = cursor.sort(["kind", "name"]).limit(selection.limit or 0)
            return tuple(row_from_document(document) for document in cursor)

        return () if selection.limit == 0 else self._with_retries(work, limit_s=_MANY_S)

    def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry, including deleted ones, sorted."""

        def work() -> tuple[tuple[str, str], ...]:
            found = self._entries.find({}, {"kind": 1, "name": 1}).sort(["kind", "name"])
            return tuple((str(document["kind"]), str(document["name"])) for document in found)

        return self._with_retries(work, limit_s=_MANY_S)

    def changes(self, kind: str, name: str) -> tuple[RevisionRow, ...]:
        """Return every revision of an entry, oldest first."""
        return self._with_retries(lambda: self._history(kind, name), limit_s=_MANY_S)

    def put(self, draft: EntryDraft, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Write an entry."""

        def decide() -> RevisionRow:
            last = self._last(draft.kind, draft.name)
            verify_revision(draft.kind, draft.name, last, expected_revision)
            return next_row(draft, last, stamp)

        return self._change(decide)

    def delete(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Delete an entry and return its last revision."""

        def decide() -> RevisionRow:
            last = self._last(kind, name)
            if last is None or last.value is None:
                raise self._not_found(kind, name)
            verify_revision(kind, name, last, expected_revision)
            return deletion_row(last, stamp)

        return self._change(decide)

    def undo(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Restore the entry before its last change."""

        def decide() -> RevisionRow:
            history = self._history(kind, name)
            if not history:
                raise self._not_found(kind, name)
            verify_revision(kind, name, history[-1], expected_revision)
            return undo_row(history, stamp)

        return self._change(decide)

    def seed(self, drafts: Sequence[EntryDraft], stamp: ChangeStamp, *, overwrite: bool) -> tuple[RevisionRow, ...]:
        """Write the drafts that are missing or, with `overwrite`, differ; in a transaction where supported."""
        write = uuid.uuid4().hex

        def work(session: ClientSession | None) -> tuple[RevisionRow, ...]:
            ids = [entry_id(draft.kind, draft.name) for draft in drafts]
            stored = {
                document["_id"]: (row_from_document(document), document.get("write"))
                for document in self._entries.find({"_id": {"$in": ids}}, session=session)
            }
            written = [row for row, by in stored.values() if by == write]  # by an interrupted attempt
            new: dict[str, RevisionRow] = {}
            for key, draft in zip(ids, drafts, strict=True):
                last, by = stored.get(key, (None, None))
                last = new.get(key, last)
                if by != write and needs_seeding(draft, last, overwrite=overwrite):
                    new[key] = next_row(draft, last, stamp)
            self._insert(list(new.values()), write, session)
            return (*written, *new.values())

        return self._atomically(work)

    def import_histories(self, histories: Sequence[Sequence[RevisionRow]]) -> tuple[RevisionRow, ...]:
        """Import entries with their revisions; return the new revisions."""
        write = uuid.uuid4().hex
        new: dict[str, RevisionRow] = {}

        def work(session: ClientSession | None) -> tuple[RevisionRow, ...]:
            missing: list[RevisionRow] = []
            for history in (each for each in histories if each):
                have = self._stored_history(history[0].kind, history[0].name, session)
                missing += missing_revisions(have, history)
                if session is None and have:
                    # An interrupted attempt may have written the revisions only.
                    self._show(have[-1], write)
            # Revisions written by an earlier attempt without a transaction are new too.
            new.update({change_id(row): row for row in missing})
            self._insert(missing, write, session)
            return tuple(new.values())

        return self._atomically(work)

    def feed(self) -> ChangeSource | None:
        """Open a feed of changes."""
        kind = MongoChangeStream if self._server.replicated else MongoChangePoller
        return kind(self._changes, address=self.address)

    def close(self) -> None:
        """Close the connections."""
        self._server.client.close()

    def _change(self, decide: Callable[[], RevisionRow]) -> RevisionRow:
        """Write the revision that `decide` returns for the present state; decide again after a concurrent write."""
        write = uuid.uuid4().hex
        claimed: list[RevisionRow] = []

        def work() -> RevisionRow:
            # After a lost connection the mark `write` shows whether the claim arrived.
            if claimed and self._changes.find_one({"_id": change_id(claimed[-1]), "write": write}) is not None:
                self._show(claimed[-1], write)
                return claimed[-1]
            while True:
                row = decide()
                claimed.append(row)
                if self._claim(row, write):
                    self._show(row, write)
                    return row

        return self._with_retries(work, writing=True)

    def _claim(self, row: RevisionRow, write: str) -> bool:
        """Insert a revision; return False when another writer has inserted it."""
        try:
            self._changes.insert_one(change_document(row, write=write))
        except DuplicateKeyError:
            found = self._changes.find_one({"_id": change_id(row)})
            if found is None:
                return False
            self._show(row_from_document(found), found["write"])
            return bool(found["write"] == write)
        return True

    def _show(self, row: RevisionRow, write: str) -> None:
        """Update the entry to a revision, unless it has that or a newer one."""
        newer = {"_id": entry_id(row.kind, row.name), "revision": {"$lt": row.revision}}
        try:
            self._entries.replace_one(newer, {**entry_document(row), "write": write}, upsert=True)
        except DuplicateKeyError:
            # No older document: the entry has this revision or a newer one.
            return

    def _insert(self, rows: Sequence[RevisionRow], write: str, session: ClientSession | None) -> None:
        if not rows:
            return
        last = {entry_id(row.kind, row.name): row for row in rows}
        self._changes.insert_many([change_document(row, write=write) for row in rows], session=session)
        shown: list[pymongo.ReplaceOne[Document]] = [
            pymongo.ReplaceOne(
                {"_id": key, "revision": {"$lt": row.revision}}, {**entry_document(row), "write": write}, upsert=True
            )
            for key, row in last.items()
        ]
        self._entries.bulk_write(shown, session=session, ordered=session is not None)

    def _atomically(self, work: Callable[[ClientSession | None], T]) -> T:
        """Run `work` in one transaction, or without one if unsupported; repeat it after a concurrent write."""

        def once() -> T:
            if not self._server.replicated:
                return work(None)
            with self._server.client.start_session() as session:
                return session.with_transaction(work)

        def until_alone() -> T:
            while True:
                try:
                    return once()
                except BulkWriteError as error:
                    collided = [each["keyValue"]["_id"] for each in _write_errors(error)]
                    if not collided:
                        raise
                    self._show_changes(collided)

        return self._with_retries(until_alone, writing=True, limit_s=_MANY_S)

    def _show_changes(self, ids: Sequence[str]) -> None:
        for document in self._changes.find({"_id": {"$in": list(ids)}}):
            self._show(row_from_document(document), document["write"])

    def _found(self, kind: str, name: str) -> RevisionRow:
        document = self._entries.find_one({"_id": entry_id(kind, name), "deleted": False})
        if document is None:
            raise self._not_found(kind, name)
        return row_from_document(document)

    def _last(self, kind: str, name: str) -> RevisionRow | None:
        """Return the last revision of an entry without reading its value, which is None for a deletion."""
        document = self._entries.find_one({"_id": entry_id(kind, name)}, _NO_VALUES)
        if document is None:
            return None
        return row_from_document({**document, **({"value": None} if document["deleted"] else {"value_json": ""})})

    def _history(self, kind: str, name: str) -> tuple[RevisionRow, ...]:
        rows = self._stored_history(kind, name, None)
        if rows:
            last = self._last(kind, name)
            if last is None or last.revision < rows[-1].revision:
                self._show_changes([change_id(rows[-1])])
        return rows

    def _stored_history(self, kind: str, name: str, session: ClientSession | None) -> tuple[RevisionRow, ...]:
        found = self._changes.find({"kind": kind, "name": name}, session=session).sort("revision")
        return tuple(row_from_document(document) for document in found)

    def _not_found(self, kind: str, name: str) -> EntryNotFound:
        others = self._entries.find({"name": name, "deleted": False}, {"kind": 1})
        alike = {"kind": kind, "deleted": False, "name": {"$gte": name[:2], "$lt": name[:2] + AFTER_PREFIX}}
        names = [*self._entries.find(alike, {"name": 1}).limit(_NEAR)]
        names += [*self._entries.find({"kind": kind, "deleted": False}, {"name": 1}).limit(_NEAR - len(names) + 1)]
        return entry_not_found(
            kind, name, elsewhere=[each["kind"] for each in others], names=[each["name"] for each in names]
        )

    def _with_retries(self, work: Callable[[], T], *, writing: bool = False, limit_s: float | None = None) -> T:
        """Run `work`, and repeat it after a lost connection until the time limit."""
        limit_s = self._patience_s if limit_s is None else max(limit_s, self._patience_s)
        deadline_s = time.monotonic() + limit_s
        what = "cannot be written" if writing else "cannot be read"
        with (
            translate_mongo_errors(what, address=self.address, user=self._server.user, writing=writing),
            pymongo.timeout(limit_s),
        ):
            while True:
                try:
                    return work()
                except PyMongoError as error:
                    if not is_retryable(error) or time.monotonic() >= deadline_s:
                        raise


def _filter(selection: EntryQuery) -> Document:
    parts: list[Document] = [{"deleted": False}]
    if selection.kind:
        parts.append({"kind": selection.kind})
    if selection.prefix:
        parts.append({"name": {"$gte": selection.prefix, "$lt": selection.prefix + AFTER_PREFIX}})
    if selection.after is not None:
        kind, name = selection.after
        parts.append({"$or": [{"kind": {"$gt": kind}}, {"kind": kind, "name": {"$gt": name}}]})
    # An equality condition on word prefixes lets an index return the entries in order, independent of their number.
    parts += [{"starts": tag_term(tag)} for tag in selection.tags]
    parts += [{"starts": word[:MAX_PREFIX]} for word in selection.words]
    long = [word for word in selection.words if len(word) > MAX_PREFIX]
    parts += [{"words": {"$elemMatch": {"$gte": word, "$lt": word + AFTER_PREFIX}}} for word in long]
    return {"$and": parts}


def _write_errors(error: BulkWriteError) -> list[dict[str, Any]]:
    """Return the id collisions of a bulk write; none when another error occurred too."""
    found: list[dict[str, Any]] = list((error.details or {}).get("writeErrors", ()))
    return found if all(each.get("code") == _DUPLICATE_KEY for each in found) else []

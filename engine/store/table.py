"""The database interface of a store: blocking operations on rows, used by one thread at a time."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Event
from typing import Protocol

from engine.errors import EntryConflict, EntryNotFound
from engine.store.rows import ChangeStamp, EntryDraft, EntryQuery, RevisionRow
from engine.wording.suggestions import did_you_mean


class ChangeSource(Protocol):
    """The changes committed by any program since the feed was opened; used by one thread."""

    def wait(self, stop: Event) -> tuple[RevisionRow, ...]:
        """Return the next changes; none after a time without changes, or soon after `stop` is set."""
        ...

    def close(self) -> None:
        """Close the feed."""
        ...


class EntryTable(Protocol):
    """Entries and all their revisions in a database; every method raises StoreError when it fails."""

    @property
    def address(self) -> str:
        """The location of the database, without secrets."""
        ...

    def get(self, kind: str, name: str) -> RevisionRow:
        """Return an entry; raises EntryNotFound."""
        ...

    def select(self, selection: EntryQuery, *, values: bool) -> tuple[RevisionRow, ...]:
        """Return entries sorted by kind and name, with their values if `values`."""
        ...

    def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry, including deleted ones, sorted."""
        ...

    def changes(self, kind: str, name: str) -> tuple[RevisionRow, ...]:
        """Return every revision of an entry, oldest first."""
        ...

    def put(self, draft: EntryDraft, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Write an entry; raises EntryConflict."""
        ...

    def delete(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Delete an entry and return its last revision; raises EntryNotFound, EntryConflict."""
        ...

    def undo(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Restore the entry before its last change; raises EntryNotFound, EntryConflict."""
        ...

    def seed(self, drafts: Sequence[EntryDraft], stamp: ChangeStamp, *, overwrite: bool) -> tuple[RevisionRow, ...]:
        """Write the drafts that are missing or, with `overwrite`, differ; return the written rows."""
        ...

    def import_histories(self, histories: Sequence[Sequence[RevisionRow]]) -> tuple[RevisionRow, ...]:
        """Import entries with their revisions; return the new revisions. Raises EntryConflict."""
        ...

    def feed(self) -> ChangeSource | None:
        """Open a feed of changes; None when no other program can access the database."""
        ...

    def close(self) -> None:
        """Close the database."""
        ...


def verify_revision(kind: str, name: str, stored: RevisionRow | None, expected: int | None) -> None:
    """Refuse a change when the entry has another revision than expected; `stored` may be a deletion."""
    revision = 0 if stored is None or stored.value is None else stored.revision
    if expected is None or revision == expected:
        return
    state = f"revision {revision} is stored" if revision else "there is no such entry"
    raise EntryConflict(
        f"{state}, revision {expected} was expected" if expected else f"{state}, no entry was expected",
        where=f"{kind} {name}",
        hint="read the entry again and retry",
    )


def entry_not_found(kind: str, name: str, *, elsewhere: Sequence[str], names: Sequence[str]) -> EntryNotFound:
    """Return the error for a missing entry.

    Args:
        kind: Kind of the missing entry.
        name: Name of the missing entry.
        elsewhere: The kinds that have an entry of this name.
        names: The names of the entries of its kind.
    """
    hint = f"there is a {elsewhere[0]} of this name" if elsewhere else did_you_mean(name, names)
    return EntryNotFound(f"there is no {kind} entry called {name}", where="store", hint=hint)


def missing_revisions(have: Sequence[RevisionRow], given: Sequence[RevisionRow]) -> Sequence[RevisionRow]:
    """Return the revisions of `given`, a whole history, that follow those of `have`.

    Raises:
        EntryConflict: `have` is not the beginning of `given`.
    """
    for mine, theirs in zip(have, given, strict=False):
        if _content(mine) != _content(theirs):
            raise EntryConflict(
                f"the target has another history: revision {mine.revision} differs",
                where=f"{mine.kind} {mine.name}",
                hint="migrate into an empty store, or export and import the entries you want",
            )
    if len(have) > len(given):
        raise EntryConflict(
            f"the target has {len(have)} revisions and the source {len(given)}",
            where=f"{have[0].kind} {have[0].name}",
            hint="the entry was changed in the target; migrate in the other direction, or into an empty store",
        )
    return given[len(have) :]


def _content(row: RevisionRow) -> tuple[object, ...]:
    return (row.revision, row.value, row.tags, row.changed_unix_ms, row.by, row.reason, row.restores)

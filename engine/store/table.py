"""What a database offers to a store: plain, blocking operations on rows, used by one thread at a time."""

from __future__ import annotations

from collections.abc import Sequence
from threading import Event
from typing import Protocol

from engine.errors import EntryConflict, EntryNotFound
from engine.store.rows import ChangeStamp, EntryDraft, EntryQuery, RevisionRow
from engine.suggestions import did_you_mean


class ChangeSource(Protocol):
    """The changes that anybody commits, from the moment it was opened; used by one thread of its own."""

    def wait(self, stop: Event) -> tuple[RevisionRow, ...]:
        """Return the next changes; none after a while without any, or soon after `stop` is set."""
        ...

    def close(self) -> None:
        """End it."""
        ...


class EntryTable(Protocol):
    """Entries and all their revisions in a database; every method raises StoreError where it fails."""

    @property
    def address(self) -> str:
        """Where the database is, without secrets."""
        ...

    def get(self, kind: str, name: str) -> RevisionRow:
        """Return an entry; raises EntryNotFound."""
        ...

    def select(self, selection: EntryQuery, *, values: bool) -> tuple[RevisionRow, ...]:
        """Return entries sorted by kind and name; their values on request."""
        ...

    def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry that ever was, sorted."""
        ...

    def changes(self, kind: str, name: str) -> tuple[RevisionRow, ...]:
        """Return every revision of an entry, oldest first."""
        ...

    def put(self, draft: EntryDraft, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Write an entry; raises EntryConflict."""
        ...

    def delete(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Remove an entry and return its last revision; raises EntryNotFound, EntryConflict."""
        ...

    def undo(self, kind: str, name: str, stamp: ChangeStamp, *, expected_revision: int | None) -> RevisionRow:
        """Bring back what was before the last change; raises EntryNotFound, EntryConflict."""
        ...

    def seed(self, drafts: Sequence[EntryDraft], stamp: ChangeStamp, *, overwrite: bool) -> tuple[RevisionRow, ...]:
        """Write those that are missing or, with `overwrite`, differ; return what was written."""
        ...

    def import_histories(self, histories: Sequence[Sequence[RevisionRow]]) -> tuple[RevisionRow, ...]:
        """Take over entries with their revisions; return those that were new. Raises EntryConflict."""
        ...

    def feed(self) -> ChangeSource | None:
        """Open a feed of changes; None where nobody else can reach the database."""
        ...

    def close(self) -> None:
        """Release the database."""
        ...


def verify_revision(kind: str, name: str, there: RevisionRow | None, expected: int | None) -> None:
    """Refuse a change where the entry has another revision than expected; `there` may be a deletion."""
    revision = 0 if there is None or there.value is None else there.revision
    if expected is None or revision == expected:
        return
    state = f"revision {revision} is there" if revision else "there is no such entry"
    raise EntryConflict(
        f"{state}, revision {expected} was expected" if expected else f"{state}, none was expected",
        where=f"{kind} {name}",
        hint="read it again and retry",
    )


def entry_not_found(kind: str, name: str, *, elsewhere: Sequence[str], names: Sequence[str]) -> EntryNotFound:
    """Return the error for a missing entry.

    Args:
        kind: Of the missing one.
        name: Of the missing one.
        elsewhere: The kinds that have an entry of this name.
        names: Of the entries of its kind.
    """
    hint = f"there is a {elsewhere[0]} of this name" if elsewhere else did_you_mean(name, names)
    return EntryNotFound(f"there is no {kind} entry called {name}", where="store", hint=hint)


def missing_revisions(have: Sequence[RevisionRow], given: Sequence[RevisionRow]) -> Sequence[RevisionRow]:
    """Return what `given`, a whole history, has beyond `have`.

    Raises:
        EntryConflict: `have` is not the beginning of `given`.
    """
    for mine, theirs in zip(have, given, strict=False):
        if _content(mine) != _content(theirs):
            raise EntryConflict(
                f"another history is there: revision {mine.revision} differs",
                where=f"{mine.kind} {mine.name}",
                hint="migrate into an empty store, or export and import the entries you want",
            )
    if len(have) > len(given):
        raise EntryConflict(
            f"it has {len(have)} revisions here and {len(given)} there",
            where=f"{have[0].kind} {have[0].name}",
            hint="it was changed here; migrate the other way, or into an empty store",
        )
    return given[len(have) :]


def _content(row: RevisionRow) -> tuple[object, ...]:
    return (row.revision, row.value, row.tags, row.changed_unix_ms, row.by, row.reason, row.restores)

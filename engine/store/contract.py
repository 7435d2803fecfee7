"""The interface of a store of named entries, independent of the database."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from types import TracebackType
from typing import Protocol, Self

import msgspec

from engine.skills.entries import EntryRecord
from engine.store.pydantic_models import PydanticModel

Value = Mapping[str, object] | msgspec.Struct | PydanticModel
"""The value of an entry to be written: its fields, or a message or pydantic model with these fields."""


class EntryKey(msgspec.Struct, frozen=True, kw_only=True, order=True):
    """An entry without its value: tags, author and time (UTC, milliseconds since 1970) of the last change."""

    kind: str
    name: str
    revision: int
    tags: tuple[str, ...] = ()
    changed_unix_ms: int = 0
    by: str = ""


class EntryChange(msgspec.Struct, frozen=True, kw_only=True):
    """One committed change of an entry: author, time (UTC, milliseconds since 1970) and reason.

    `value` is None for a deletion. `restores` is the revision whose content an undo restored,
    0 when there was no entry before; None when the change is not an undo.
    """

    kind: str
    name: str
    revision: int
    value: dict[str, object] | None
    tags: tuple[str, ...] = ()
    changed_unix_ms: int = 0
    by: str = ""
    reason: str = ""
    restores: int | None = None


ChangeListener = Callable[[EntryChange], None]


class Store(Protocol):
    """Named entries: joint configurations, poses, DMPs and other typed records.

    Kind and name together identify an entry. Revisions count the changes of one entry from 1; a
    deletion is a change, so a revision is never reused. A cancelled method may still have taken
    effect. All methods raise StoreError with the kind and name when a limit is exceeded or the
    database fails. `by` is the author of a change and `reason` its reason; both are free text.
    """

    @property
    def address(self) -> str:
        """The location of the entries: a file path or a server address, without secrets."""
        ...

    async def get(self, kind: str, name: str) -> EntryRecord:
        """Return an entry.

        Raises:
            EntryNotFound: there is none; the hint suggests similar names.
        """
        ...

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
        """Write an entry durably and return it as stored.

        Args:
            kind: One of the kinds of the store.
            name: Lower case letters, digits and `_ / . -`.
            value: The fields of its kind; validated.
            expected_revision: Write only when the stored entry has this revision; 0 means that
                there must be no entry.
            tags: Replace the present tags; None keeps them.
            by: The author.
            reason: The reason.

        Raises:
            StoreError: the value is invalid.
            EntryConflict: another revision is stored; the message names it.
        """
        ...

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
        """Return the entries that meet all conditions, sorted by kind and name.

        Args:
            kind: Only this kind.
            prefix: Only names that begin with it.
            tags: Only entries with all these tags.
            text: Only entries where each of its words is the beginning of a word of the name or of a tag.
            after: Only entries after this one: the last of the previous page.
            limit: Maximum number of entries.
        """
        ...

    async def delete(
        self, kind: str, name: str, *, expected_revision: int | None = None, by: str = "", reason: str = ""
    ) -> None:
        """Delete an entry; its history is kept, and `undo` restores it.

        Raises:
            EntryNotFound: there is none.
            EntryConflict: another revision than expected is stored.
        """
        ...

    async def undo(
        self, kind: str, name: str, *, expected_revision: int | None = None, by: str = "", reason: str = ""
    ) -> EntryChange:
        """Restore value and tags from before the last change as a new revision, and return that change.

        Each further undo goes one change back. An entry that did not exist before is deleted.

        Raises:
            EntryNotFound: the entry never existed.
            EntryConflict: another revision than expected is stored.
            StoreError: there is no change left to undo.
        """
        ...

    async def history(self, kind: str, name: str) -> tuple[EntryChange, ...]:
        """Return every change of an entry, oldest first; empty when it never existed."""
        ...

    async def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry, including deleted ones, sorted."""
        ...

    async def export(self, *, kind: str = "", prefix: str = "") -> tuple[EntryRecord, ...]:
        """Return entries with their values and tags, sorted by kind and name, as input for `seed`."""
        ...

    async def seed(
        self, entries: Iterable[EntryRecord], *, overwrite: bool = False, by: str = "", reason: str = ""
    ) -> tuple[EntryKey, ...]:
        """Write the missing entries, all or none of them, and return those written.

        A MongoDB server without a replica set cannot write several entries atomically: there,
        seed again after an interruption.

        Args:
            entries: Their revisions are ignored; an entry without tags keeps its present tags.
            overwrite: Also write entries that are stored with another value or other tags.
            by: The author.
            reason: The reason.
        """
        ...

    async def import_histories(self, histories: Iterable[Sequence[EntryChange]]) -> int:
        """Import entries with their whole histories from another store; return the number of new changes.

        Raises:
            EntryConflict: an entry has another history in this store.
        """
        ...

    def watch(self, listener: ChangeListener) -> Callable[[], None]:
        """Call `listener` on the event loop after each change committed here; returns a function that ends this."""
        ...

    async def follow(self, listener: ChangeListener) -> Callable[[], None]:
        """Watch, and also receive the changes of other programs; returns a function that ends this.

        A store opened `inline` receives only its own changes.
        """
        ...

    async def close(self) -> None:
        """Close the database; may be called again."""
        ...

    async def __aenter__(self) -> Self:
        """Return the store."""
        ...

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close."""
        ...

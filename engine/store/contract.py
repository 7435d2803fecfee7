"""What every store of named entries does, whichever database is behind it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from types import TracebackType
from typing import Protocol, Self

import msgspec

from engine.skills.entries import EntryRecord
from engine.store.pydantic_models import PydanticModel

Value = Mapping[str, object] | msgspec.Struct | PydanticModel
"""An entry's value on its way in: its fields, or a message or pydantic model that has them."""


class EntryKey(msgspec.Struct, frozen=True, kw_only=True, order=True):
    """An entry without its value: its tags, who changed it last and when (UTC, milliseconds since 1970)."""

    kind: str
    name: str
    revision: int
    tags: tuple[str, ...] = ()
    changed_unix_ms: int = 0
    by: str = ""


class EntryChange(msgspec.Struct, frozen=True, kw_only=True):
    """One committed change of an entry: by whom, when (UTC, milliseconds since 1970) and why.

    `value` is None where it was deleted. `restores` is the revision whose content an undo brought
    back, 0 where there was no entry before; None where the change is no undo.
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

    Kind and name together name an entry. Revisions count the changes of one entry from 1; a
    deletion is a change, so a revision never comes twice. A method that is cancelled may still
    have taken effect. All methods raise StoreError with the kind and name where a limit is
    exceeded or the database fails. `by` says who changes an entry and `reason` why; both are free text.
    """

    @property
    def address(self) -> str:
        """Where the entries are: the path of a file, or the address of a server, without secrets."""
        ...

    async def get(self, kind: str, name: str) -> EntryRecord:
        """Return an entry.

        Raises:
            EntryNotFound: there is none; the hint has the near names.
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
            kind: One of the kinds the store knows.
            name: Lower case letters, digits and `_ / . -`.
            value: The fields of its kind; checked.
            expected_revision: Write only when the stored entry has this revision; 0 means that
                there must be none.
            tags: Replace those it has; None keeps them.
            by: Who writes it.
            reason: Why.

        Raises:
            StoreError: the value does not fit.
            EntryConflict: another revision is there (the message says which).
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
            prefix: Only names that begin so.
            tags: Only entries with all these tags.
            text: Only entries where each word of it begins a word of the name or of a tag.
            after: Only those behind this one: the last of the page before.
            limit: At most so many.
        """
        ...

    async def delete(
        self, kind: str, name: str, *, expected_revision: int | None = None, by: str = "", reason: str = ""
    ) -> None:
        """Remove an entry; its history stays, and `undo` brings it back.

        Raises:
            EntryNotFound: there is none.
            EntryConflict: another revision is there than expected.
        """
        ...

    async def undo(
        self, kind: str, name: str, *, expected_revision: int | None = None, by: str = "", reason: str = ""
    ) -> EntryChange:
        """Bring back value and tags from before the last change, as a new revision, and return that.

        Undoing again goes one step further into the past. An entry that was not there before is deleted.

        Raises:
            EntryNotFound: there never was such an entry.
            EntryConflict: another revision is there than expected.
            StoreError: nothing is left to undo.
        """
        ...

    async def history(self, kind: str, name: str) -> tuple[EntryChange, ...]:
        """Return every change of an entry, oldest first; empty when it never was."""
        ...

    async def all_names(self) -> tuple[tuple[str, str], ...]:
        """Return kind and name of every entry that ever was, also of deleted ones, sorted."""
        ...

    async def export(self, *, kind: str = "", prefix: str = "") -> tuple[EntryRecord, ...]:
        """Return entries with their values and tags, sorted by kind and name; `seed` takes them back."""
        ...

    async def seed(
        self, entries: Iterable[EntryRecord], *, overwrite: bool = False, by: str = "", reason: str = ""
    ) -> tuple[EntryKey, ...]:
        """Write the entries that are missing, all or none of them, and return those written.

        A MongoDB server without a replica set cannot write several entries at once: there, what
        breaks off half way is completed by seeding again.

        Args:
            entries: Their revisions are ignored; without tags they keep those they have.
            overwrite: Write also those that are there with another value or other tags.
            by: Who writes them.
            reason: Why.
        """
        ...

    async def import_histories(self, histories: Iterable[Sequence[EntryChange]]) -> int:
        """Take over entries with their whole histories from another store; return how many changes were new.

        Raises:
            EntryConflict: an entry has another history here.
        """
        ...

    def watch(self, listener: ChangeListener) -> Callable[[], None]:
        """Call `listener` on the event loop after each change committed here; returns what ends it."""
        ...

    async def follow(self, listener: ChangeListener) -> Callable[[], None]:
        """Watch, and from now on also hear what other programs commit; returns what ends it.

        A store opened `inline` follows nobody else.
        """
        ...

    async def close(self) -> None:
        """Release the database; may be called again."""
        ...

    async def __aenter__(self) -> Self:
        """Return the store."""
        ...

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close."""
        ...

"""What every store of named entries does, whichever database is behind it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import TracebackType
from typing import Protocol, Self

import msgspec

from engine.skills.entries import EntryRecord

Value = Mapping[str, object] | msgspec.Struct
"""An entry's value on its way in: its fields, or a message that has them."""


class EntryKey(msgspec.Struct, frozen=True, kw_only=True, order=True):
    """An entry without its value."""

    kind: str
    name: str
    revision: int


class EntryChange(msgspec.Struct, frozen=True, kw_only=True):
    """One committed change of an entry; `value` is None where it was deleted."""

    kind: str
    name: str
    revision: int
    value: dict[str, object] | None


ChangeListener = Callable[[EntryChange], None]


class Store(Protocol):
    """Named entries: joint configurations, poses, DMPs and other typed records.

    Kind and name together name an entry. Revisions count the changes of one entry from 1; a
    deletion is a change, so a revision never comes twice. A method that is cancelled may still
    have taken effect. All methods raise StoreError with the kind and name where a limit is
    exceeded or the database fails.
    """

    async def get(self, kind: str, name: str) -> EntryRecord:
        """Return an entry.

        Raises:
            EntryNotFound: there is none; the hint has the near names.
        """
        ...

    async def put(self, kind: str, name: str, value: Value, *, expected_revision: int | None = None) -> EntryRecord:
        """Write an entry durably and return it as stored.

        Args:
            kind: One of the kinds the store knows.
            name: Lower case letters, digits and `_ / . -`.
            value: The fields of its kind; checked.
            expected_revision: Write only when the stored entry has this revision; 0 means that
                there must be none.

        Raises:
            StoreError: the value does not fit, or another revision is there (the message says which).
        """
        ...

    async def list(self, *, kind: str = "", prefix: str = "") -> tuple[EntryKey, ...]:
        """Return the entries of a kind (of all when empty) whose name begins with `prefix`, sorted."""
        ...

    async def delete(self, kind: str, name: str, *, expected_revision: int | None = None) -> None:
        """Remove an entry; its history stays.

        Raises:
            EntryNotFound: there is none.
            StoreError: another revision is there than expected.
        """
        ...

    async def history(self, kind: str, name: str) -> tuple[EntryChange, ...]:
        """Return every change of an entry, oldest first; empty when it never was."""
        ...

    async def export(self, *, kind: str = "", prefix: str = "") -> tuple[EntryRecord, ...]:
        """Return entries with their values, sorted by kind and name; `seed` takes them back."""
        ...

    async def seed(self, entries: Iterable[EntryRecord], *, overwrite: bool = False) -> tuple[EntryKey, ...]:
        """Write the entries that are missing, all or none of them, and return those written.

        Args:
            entries: Their revisions are ignored.
            overwrite: Write also those that are there with another value.
        """
        ...

    def watch(self, listener: ChangeListener) -> Callable[[], None]:
        """Call `listener` on the event loop after each change committed here; returns what ends it."""
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

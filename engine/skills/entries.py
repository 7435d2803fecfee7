"""Named entries over the bus, answered under `store` (RCY 2.2)."""

from __future__ import annotations

import msgspec

from engine.messages import Message
from engine.skill import Service


class EntryRecord(Message, frozen=True, kw_only=True):
    """A named entry as stored: `value` has the fields of its `kind`; `revision` counts its changes."""

    kind: str
    name: str
    value: dict[str, object]
    revision: int


class ReadEntry(Service[EntryRecord], frozen=True, kw_only=True):
    """Return the entry `name` of `kind`; fails with the near names when there is none."""

    kind: str
    name: str


class WriteEntry(Service[EntryRecord], frozen=True, kw_only=True):
    """Write an entry; with `expected_revision`, only when the stored one still has it."""

    kind: str
    name: str
    value: dict[str, object]
    expected_revision: int | None = None


class EntryList(Message, frozen=True, kw_only=True):
    """The entries that matched, without their values."""

    entries: tuple[tuple[str, str, int], ...] = msgspec.field(default=())


class ListEntries(Service[EntryList], frozen=True, kw_only=True):
    """List (kind, name, revision) of the entries of `kind` (all kinds when empty) under `prefix`."""

    kind: str = ""
    prefix: str = ""

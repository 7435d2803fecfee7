"""store.WriteEntry: writes a value from userdata as a named entry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import EntryConflict
from engine.skills import entries
from engine.state import Context, Outcome, State
from states.store.store_parameter_types import EntryKindName, NewEntryName


class WriteEntry(State, frozen=True, kw_only=True):
    """Write `value` as a named entry.

    With `expected_revision` (from `store.ReadEntry`; 0 for a new entry) the entry is written only if it has that
    revision, else the outcome is `conflict`.
    """

    state_name: ClassVar[str] = "store.WriteEntry"
    outcomes: ClassVar[tuple[str, ...]] = ("written", "conflict")
    success: ClassVar[tuple[str, ...]] = ("written",)
    outputs: ClassVar[Mapping[str, Any]] = {"revision": int}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"conflict": ("revision",)}

    kind: EntryKindName
    name: NewEntryName

    async def run(self, ctx: Context, *, value: dict[str, object], expected_revision: int | None = None) -> Outcome:
        """Write to the store; a value that the store refuses raises an error."""
        request = entries.WriteEntry(kind=self.kind, name=self.name, value=value, expected_revision=expected_revision)
        try:
            record = await ctx.call(request, to="store")
        except EntryConflict as error:
            message = f"{self.kind} entry {self.name} was changed by another writer"
            return Outcome("conflict", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        return Outcome("written", {"revision": record.revision})

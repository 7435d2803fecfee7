"""store.ReadEntry: reads a named entry into userdata."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import EntryNotFound
from engine.skills import entries
from engine.state import Context, Outcome, State, nothing_to_undo
from states.store.store_parameter_types import EntryKindName, StoredEntryName


class ReadEntry(State, frozen=True, kw_only=True):
    """Read a named entry: its fields into `value`, its revision into `revision`."""

    state_name: ClassVar[str] = "store.ReadEntry"
    outcomes: ClassVar[tuple[str, ...]] = ("found", "missing")
    success: ClassVar[tuple[str, ...]] = ("found",)
    outputs: ClassVar[Mapping[str, Any]] = {"value": dict[str, object], "revision": int}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"missing": ("value", "revision")}
    undo = nothing_to_undo

    kind: EntryKindName
    name: StoredEntryName

    async def run(self, ctx: Context) -> Outcome:
        """Read from the store; a missing entry gives the outcome `missing`, a store failure raises an error."""
        try:
            record = await ctx.call(entries.ReadEntry(kind=self.kind, name=self.name), to="store")
        except EntryNotFound as error:
            message = f"{self.kind} entry {self.name} cannot be read"
            return Outcome("missing", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        return Outcome("found", {"value": record.value, "revision": record.revision})

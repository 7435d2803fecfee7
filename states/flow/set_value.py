"""flow.SetValue: writes a value to userdata."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.state import Context, Outcome, State, nothing_to_undo


class SetValue(State, frozen=True, kw_only=True):
    """Write a value to the userdata key given by `out: {value: key}`."""

    state_name: ClassVar[str] = "flow.SetValue"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    success: ClassVar[tuple[str, ...]] = ("done",)
    instant: ClassVar[bool] = True
    outputs: ClassVar[Mapping[str, Any]] = {"value": object}
    undo = nothing_to_undo

    value: Annotated[object, Meta(description="Any value, or an expression", extra_json_schema={"output": "value"})]

    async def run(self, ctx: Context) -> Outcome:
        """Write the value."""
        return Outcome("done", {"value": self.value})

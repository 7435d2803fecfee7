"""flow.Log: writes a line into the event log."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from msgspec import Meta

from engine.state import Context, Outcome, State, nothing_to_undo


class Log(State, frozen=True, kw_only=True):
    """Write a line into the event log of the run."""

    state_name: ClassVar[str] = "flow.Log"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    success: ClassVar[tuple[str, ...]] = ("done",)
    instant: ClassVar[bool] = True
    undo = nothing_to_undo

    message: Annotated[str, Meta(description="Text of the line")]
    level: Annotated[Literal["debug", "info", "warning", "error"], Meta(description="Severity")] = "info"

    async def run(self, ctx: Context) -> Outcome:
        """Write the line."""
        ctx.log(self.message, level=self.level)
        return Outcome("done")

"""flow.Decide: branches on a condition."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.errors import Cause
from engine.state import Context, Outcome, State, nothing_to_undo


class Decide(State, frozen=True, kw_only=True):
    """Branch on a condition, usually an expression: `when: ${width > 0.04}`."""

    state_name: ClassVar[str] = "flow.Decide"
    outcomes: ClassVar[tuple[str, ...]] = ("true", "false")
    success: ClassVar[tuple[str, ...]] = ("true",)
    instant: ClassVar[bool] = True
    undo = nothing_to_undo

    when: Annotated[bool, Meta(description="The condition")]

    async def run(self, ctx: Context) -> Outcome:
        """Return the outcome of the condition."""
        if self.when:
            return Outcome("true")
        return Outcome("false", cause=Cause(message="the condition is false", where=ctx.path, kind=self.state_name))

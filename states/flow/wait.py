"""flow.Wait: waits for a duration."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.state import Context, Outcome, State, nothing_to_undo


class Wait(State, frozen=True, kw_only=True):
    """Wait for a duration on the run's clock."""

    state_name: ClassVar[str] = "flow.Wait"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    success: ClassVar[tuple[str, ...]] = ("done",)
    undo = nothing_to_undo

    duration_s: Annotated[float, Meta(ge=0, description="Duration of the wait", extra_json_schema={"unit": "s"})]

    async def run(self, ctx: Context) -> Outcome:
        """Sleep for the duration."""
        await ctx.clock.sleep(self.duration_s)
        return Outcome("done")

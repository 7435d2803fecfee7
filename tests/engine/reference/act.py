"""One state that can do whatever a state can do to its surroundings."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, ClassVar, Literal

from engine.state import Context, Outcome, State


class Act(State, frozen=True, kw_only=True):
    """Take a time, then end or raise; when preempted clean up for a time, then rest, refuse or raise."""

    state_name: ClassVar[str] = "test.Act"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b", "c")
    success: ClassVar[tuple[str, ...]] = ("a", "b")
    outputs: ClassVar[Mapping[str, Any]] = {"sum": int}
    after_s: float = 0.0
    ends: Literal["a", "b", "c", "raise"] = "a"
    add: int = 0
    cleanup_s: float = 0.0
    when_preempted: Literal["rest", "refuse", "raise"] = "rest"

    async def run(self, ctx: Context, *, seen: int = 0) -> Outcome:
        try:
            if self.after_s:
                await ctx.clock.sleep(self.after_s)
        except asyncio.CancelledError:
            if self.cleanup_s:
                await ctx.clock.sleep(self.cleanup_s)
            if self.when_preempted == "refuse":
                return Outcome("c")
            if self.when_preempted == "raise":
                raise ZeroDivisionError("in the clean-up") from None
            raise
        if self.ends == "raise":
            raise ZeroDivisionError("division by zero")
        return Outcome(self.ends, {"sum": seen + self.add} if self.add else {})


CATALOGUE: dict[str, type[State]] = {Act.state_name: Act}

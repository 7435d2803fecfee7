"""Leaves for tests of trees: they do what a script says, activation after activation."""

from __future__ import annotations

import asyncio
from typing import ClassVar

from engine.document.state_catalogue import StateCatalogue
from engine.state import Context, Outcome, State
from tests.engine.fake_states import CATALOGUE as FAKE_STATES
from tests.engine.runtime.tree import foreign_behaviours

COUNTS: dict[str, int] = {}
"""Activations so far, by path; cleared by `run_tree`."""
REMAINING: dict[str, float] = {}
"""For leaves that go on with an activation that was cut: what is left of it, by path."""


class Check(State, frozen=True, kw_only=True):
    """Take so long and end so, for each activation; the last entry of the script holds on. Preempted, say so."""

    state_name: ClassVar[str] = "test.Check"
    outcomes: ClassVar[tuple[str, ...]] = ("yes", "no")
    success: ClassVar[tuple[str, ...]] = ("yes",)
    script: tuple[tuple[float, bool], ...] = ((0.0, True),)
    cleanup_s: float = 0.0

    async def run(self, ctx: Context) -> Outcome:
        goes_on = ctx.path in REMAINING
        count = COUNTS[ctx.path] = COUNTS.get(ctx.path, 0) + (not goes_on)
        duration_s, good = self.script[min(count, len(self.script)) - 1]
        duration_s = REMAINING.pop(ctx.path, duration_s)
        if duration_s > 0:
            try:
                await ctx.clock.sleep(duration_s)
            except asyncio.CancelledError:
                if self.cleanup_s:
                    await ctx.clock.sleep(self.cleanup_s)
                ctx.log("clean")
                raise
        return Outcome("yes" if good else "no")


class Act(Check, frozen=True, kw_only=True):
    """The same, and it commands a device."""

    state_name: ClassVar[str] = "test.Act"
    robot: str = ""

    def resources(self) -> tuple[str, ...]:
        return (self.robot,) if self.robot else ()


CATALOGUE = StateCatalogue(
    {**FAKE_STATES, "test.Check": Check, "test.Act": Act}, modules={foreign_behaviours.__name__: foreign_behaviours}
)

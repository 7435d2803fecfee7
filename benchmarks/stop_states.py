"""A state that keeps the event loop from running, as a mistake in a state would; for `benchmarks/stop.py`."""

from __future__ import annotations

import re
import time
from pathlib import Path
from typing import ClassVar

from engine.state import Context, Outcome, State


class Block(State, frozen=True, kw_only=True):
    """Say in a file that the arm moves, then block: `sleep` leaves the interpreter to others, `hold` does not."""

    state_name: ClassVar[str] = "benchmark.Block"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    how: str
    after_s: float
    for_s: float
    marker: str

    async def run(self, ctx: Context) -> Outcome:
        """Block the event loop for the time given, or wait without blocking it."""
        await ctx.clock.sleep(self.after_s)
        Path(self.marker).write_bytes(b"moving")  # noqa: ASYNC240 - blocking is what this state is for
        match self.how:
            case "sleep":
                time.sleep(self.for_s)  # noqa: ASYNC251
            case "hold":
                deadline_s = time.monotonic() + self.for_s
                while time.monotonic() < deadline_s:
                    # Backtracking in C: meanwhile no other thread of this process runs.
                    re.match(r"(a+)+$", "a" * 23 + "b")
            case _:
                await ctx.clock.sleep(3600.0)
        return Outcome("done")

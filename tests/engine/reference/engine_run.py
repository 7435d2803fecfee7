"""Runs a behavior on the engine in virtual time, stopped at an instant."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import Behavior
from engine.event import Event
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.reference.act import CATALOGUE


@dataclass(frozen=True)
class ObservedRun:
    """What the engine made of a behavior."""

    result: RunResult
    events: tuple[Event, ...]


def run_to_end(behavior: Behavior, stop_at_s: float, seed: int = 0) -> ObservedRun:
    """Run it to its end, or to the stop."""
    plan = new_plan(behavior, CATALOGUE)
    events: list[Event] = []

    async def main() -> RunResult:
        run = Run(plan, run="r", bus=SkillBus(new_clock()), seed=seed)
        run.watch(events.append)
        timer = asyncio.get_running_loop().call_later(stop_at_s, run.stop, "test")
        try:
            return await run.execute()
        finally:
            timer.cancel()

    return ObservedRun(run_virtual(main()), tuple(events))

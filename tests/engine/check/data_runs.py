"""Runs a behavior whose states write and read userdata, for at most a hundred virtual seconds."""

from __future__ import annotations

import asyncio
import json

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from tests.engine.check.data_states import CATALOGUE
from tests.engine.check.random_behaviors import Plain


def events_of(document: Plain, seed: int) -> list[Event]:
    """Run a document for at most a hundred virtual seconds and return its events."""
    plan = new_plan(parse_behavior(json.dumps(document), file="random.json"), CATALOGUE)
    events: list[Event] = []

    async def main() -> None:
        run = Run(plan, run="r", bus=SkillBus(new_clock()), seed=seed, instant_limit=300)
        run.watch(events.append)
        # Some loops go round without letting time pass.
        run.watch(lambda event: run.stop("far enough") if event.seq == 3000 else None)
        asyncio.get_running_loop().call_later(100.0, run.stop, "long enough")
        await run.execute()

    run_virtual(main())
    return events

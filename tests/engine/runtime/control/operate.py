"""Runs a behavior in virtual time while an operator, told when to do what, controls it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping
from textwrap import dedent
from typing import cast

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event
from engine.journal import MemoryRunJournal
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.state import State
from tests.engine.fake_states import CATALOGUE
from tests.engine.run_document import HEAD, ObservedRun
from tests.engine.runtime.control.turntable import TurnTable

Act = Callable[[Run], object]
"""What is done with the run; a coroutine is awaited by itself."""


def pause(run: Run) -> None:
    """Hold the run."""
    run.control.pause()


def resume(run: Run) -> None:
    """Let it go on."""
    run.control.resume()


def operate(
    text: str,
    acts: Mapping[float, Act],
    *,
    supervision: RunOptions | None = None,
    inputs: Mapping[str, object] | None = None,
    prepare: Callable[[SkillBus], object] = lambda bus: None,
    states: Mapping[str, type[State]] | None = None,
) -> ObservedRun:
    """Run a document; at each time in seconds do what `acts` says with the run; raises what that raises."""
    body = dedent(text)
    plan = new_plan(
        parse_behavior(body if "flexcell" in body else HEAD + body, file="test.yaml"),
        {**CATALOGUE, "test.TurnTable": TurnTable, **(states or {})},
    )

    async def main() -> ObservedRun:
        bus = SkillBus(new_clock())
        events: list[Event] = []
        async with bus:
            prepare(bus)
            journal = MemoryRunJournal(run_id="r1")
            run = Run(plan, run="r1", bus=bus, supervision=supervision, inputs=inputs, journal=journal)
            run.watch(events.append)
            loop = asyncio.get_running_loop()
            under_way: list[asyncio.Task[object]] = []
            failures: list[Exception] = []

            def do(act: Act) -> None:
                try:
                    made = act(run)
                except Exception as error:
                    # A timer's callback that raises is only logged: the test must fail by it.
                    failures.append(error)
                    return
                if isinstance(made, Coroutine):
                    under_way.append(loop.create_task(cast("Coroutine[object, object, object]", made)))

            timers = [loop.call_at(at_s, do, act) for at_s, act in acts.items()]
            result = await run.execute()
            for timer in timers:
                timer.cancel()
            for task in under_way:
                await task
            if failures:
                raise failures[0]
        return ObservedRun(result, tuple(events))

    return run_virtual(main())

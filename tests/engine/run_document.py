"""Runs a behavior written in a test in virtual time and returns what came of it."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from textwrap import dedent

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event, MessageLogged, NodeEntered, NodeExited
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.fake_states import WITH_FLOW


@dataclass(frozen=True)
class ObservedRun:
    """A run's result and its events."""

    result: RunResult
    events: tuple[Event, ...]

    @property
    def lines(self) -> list[str]:
        """What happened, a word an event: `+path`, `-path outcome`, `!message`."""
        lines: list[str] = []
        for event in self.events:
            match event:
                case NodeEntered():
                    lines.append(f"+{event.path}")
                case NodeExited():
                    lines.append(f"-{event.path} {'preempted' if event.preempted else event.outcome or 'error'}")
                case MessageLogged():
                    lines.append(f"!{event.path} {event.message}")
                case _:
                    pass
        return lines


HEAD = "flexcell: 1\nname: test\noutcomes: [good, bad]\nsuccess: [good]\n"


def plan_of(text: str) -> Plan:
    """Plan a document; text without `flexcell:` gets a head with outcomes good and bad."""
    body = dedent(text)
    return new_plan(parse_behavior(body if "flexcell:" in body else HEAD + body, file="test.yaml"), WITH_FLOW)


def run_document(
    text: str,
    *,
    stop_at_s: float | None = None,
    stop_first: bool = False,
    parameters: Mapping[str, object] | None = None,
    inputs: Mapping[str, object] | None = None,
    seed: int = 0,
    polling_limit: int = 20_000,
) -> ObservedRun:
    """Run a document to its end in virtual time."""
    plan = plan_of(text)
    events: list[Event] = []

    async def main() -> RunResult:
        bus = SkillBus(new_clock())
        run = Run(plan, run="r", bus=bus, parameters=parameters, inputs=inputs, seed=seed, polling_limit=polling_limit)
        run.watch(events.append)
        if stop_first:
            run.stop("changed my mind")
        if stop_at_s is not None:
            asyncio.get_running_loop().call_later(stop_at_s, run.stop, "test")
        return await run.execute()

    return ObservedRun(run_virtual(main()), tuple(events))

"""flexcell itself: behaviors are documents, loaded, planned and run as users run them."""

from __future__ import annotations

import asyncio
import itertools
import tempfile
import time
from collections.abc import Callable
from typing import ClassVar

import msgspec

from benchmarks.sample import Reactions, Sample, Stopwatch
from engine.bus import SkillBus
from engine.check import check_behavior
from engine.clock import new_clock
from engine.document import parse_behavior
from engine.event import Event
from engine.journal import Journal, RunJournal
from engine.runtime.history.resume import read_history
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.state import Context, Outcome, State

_REACTIONS: list[Reactions] = []
"""Who measures in this process: a state has no way to be handed an object, only data."""
_HEAD = "flexcell: 1\nname: bench\noutcomes: [good]\nroot:\n"


class Step(State, frozen=True, kw_only=True):
    """End at once."""

    state_name: ClassVar[str] = "bench.Step"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done")


class Tick(State, frozen=True, kw_only=True):
    """Wait and be woken again and again."""

    state_name: ClassVar[str] = "bench.Tick"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    times: int

    async def run(self, ctx: Context) -> Outcome:
        for _ in range(self.times):
            await ctx.clock.sleep(0)
        return Outcome("done")


class Go(msgspec.Struct, frozen=True):
    """The message that is waited for."""


class Await(State, frozen=True, kw_only=True):
    """Wait for a message."""

    state_name: ClassVar[str] = "bench.Await"
    outcomes: ClassVar[tuple[str, ...]] = ("go",)

    async def run(self, ctx: Context) -> Outcome:
        for reactions in _REACTIONS:
            reactions.waiting()
        await ctx.next_message("go", Go)
        return Outcome("go")


class Mark(State, frozen=True, kw_only=True):
    """The state after the event: note when it was entered."""

    state_name: ClassVar[str] = "bench.Mark"
    outcomes: ClassVar[tuple[str, ...]] = ("again", "done")

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done" if all(reactions.entered() for reactions in _REACTIONS) else "again")


_CATALOGUE: dict[str, type[State]] = {state.state_name: state for state in (Step, Tick, Await, Mark)}


def chain(watch: Stopwatch, states: int) -> Sample:
    """Run a machine of states that end at once."""
    plan = _plan(_machine(states, "good", indent="  "))
    return asyncio.run(_measured(watch, plan, states))


def watched_chain(watch: Stopwatch, states: int) -> Sample:
    """The same with somebody who takes every event."""
    plan = _plan(_machine(states, "good", indent="  "))
    return asyncio.run(_measured(watch, plan, states, watched=True))


def tree_chain(watch: Stopwatch, states: int) -> Sample:
    """Run a behavior tree, a sequence of states that end at once."""
    plan = _plan(_tree("sequence", states, "{state: bench.Step}"))
    return asyncio.run(_measured(watch, plan, states))


def tree_ticks(watch: Stopwatch, children: int, times: int) -> Sample:
    """Wake each leaf of a parallel again and again."""
    plan = _plan(_tree("parallel", children, f"{{state: bench.Tick, with: {{times: {times}}}}}"))
    return asyncio.run(_measured(watch, plan, children * times))


def resumed_chain(watch: Stopwatch, states: int) -> Sample:
    """Read the events of a machine of states and find out where it stands; a unit is a state."""
    plan = _plan(_machine(states, "good", indent="  "))
    events: list[Event] = []

    async def record() -> None:
        run = Run(plan, run="bench", bus=SkillBus(new_clock()))
        run.watch(events.append)
        await run.execute()

    asyncio.run(record())
    return watch.measure(states, lambda: read_history(plan, "bench", events).checkpoint())


def journaled_chain(watch: Stopwatch, states: int) -> Sample:
    """The same with every event on the disk before the run ends."""
    plan = _plan(_machine(states, "good", indent="  "))
    number = itertools.count()
    with tempfile.TemporaryDirectory() as folder, Journal.open(folder) as journal:

        def begin() -> RunJournal:
            return journal.begin(f"run-{next(number)}", behavior="bench", document=plan.document_hash, started_unix_s=0)

        return asyncio.run(_measured(watch, plan, states, begin))


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """Run a concurrency container of machines."""
    child = _machine(states, "end", indent="        ")
    plan = _plan(_concurrency(count, f"\n{child}", "end"))
    return asyncio.run(_measured(watch, plan, count * states))


def ticks(watch: Stopwatch, children: int, times: int) -> Sample:
    """Wake each child of a concurrency container again and again."""
    plan = _plan(_concurrency(children, f"{{state: bench.Tick, with: {{times: {times}}}}}", "done"))
    return asyncio.run(_measured(watch, plan, children * times))


def reaction(watch: Stopwatch, events: int) -> Sample:
    """Post a message from another thread; the waiting state ends and the next one is entered."""
    plan = _plan(
        "  machine:\n    initial: wait\n    states:\n"
        "      wait: {state: bench.Await, transitions: {go: mark}}\n"
        "      mark: {state: bench.Mark, transitions: {again: wait, done: good}}\n"
    )

    async def main() -> Sample:
        bus = SkillBus(new_clock())
        topic = bus.topic("go", Go)
        reactions = Reactions(events, lambda: bus.post(lambda: topic.publish(Go())))
        _REACTIONS.append(reactions)
        await _run(plan, bus)
        return reactions.sample()

    return asyncio.run(main())


def idle(watch: Stopwatch, children: int, duration_ms: int) -> Sample:
    """Let branches wait for a message that does not come."""
    plan = _plan(_concurrency(children, "{state: bench.Await}", "go"))

    async def main() -> Sample:
        bus = SkillBus(new_clock())
        run = Run(plan, run="idle", bus=bus)
        task = asyncio.create_task(run.execute())
        await asyncio.sleep(0.2)
        cpu_s, wall_s = time.process_time(), time.perf_counter()
        await asyncio.sleep(duration_ms / 1000)
        sample = Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)
        run.stop("measured")
        await task
        return sample

    return asyncio.run(main())


def load(watch: Stopwatch, states: int) -> Sample:
    """Read a document, check it and plan it, once: what a user waits for."""
    text = _HEAD + _machine(states, "good", indent="  ")
    cpu_s, wall_s = time.process_time(), time.perf_counter()
    behavior = parse_behavior(text, file="bench.yaml")
    if check_behavior(behavior, _CATALOGUE):
        raise AssertionError("the benchmark's document has findings")
    new_plan(behavior, _CATALOGUE)
    return Sample(states, time.process_time() - cpu_s, time.perf_counter() - wall_s)


def _tree(kind: str, children: int, child: str) -> str:
    """Return a machine with one tree in it."""
    leaves = "".join(f"\n            - {child}" for _ in range(children))
    return (
        "  machine:\n    initial: tree\n    states:\n      tree:\n"
        f"        tree:\n          {kind}:{leaves}\n"
        "        transitions: {success: good, failure: good}\n"
    )


async def _measured(
    watch: Stopwatch,
    plan: Plan,
    units: int,
    begin: Callable[[], RunJournal | None] = lambda: None,
    *,
    watched: bool = False,
) -> Sample:
    bus = SkillBus(new_clock())
    return await watch.measure_async(units, lambda: _run(plan, bus, begin(), watched=watched))


async def _run(plan: Plan, bus: SkillBus, journal: RunJournal | None = None, *, watched: bool = False) -> None:
    run = Run(plan, run="bench", bus=bus, journal=journal)
    if watched:
        run.watch(list[Event]().append)
    result = await run.execute()
    if result.status != "finished":
        raise AssertionError(f"the benchmark's run ended {result.status}: {result.cause}")


def _plan(root: str) -> Plan:
    return new_plan(parse_behavior(_HEAD + root, file="bench.yaml"), _CATALOGUE)


def _machine(states: int, outcome: str, *, indent: str) -> str:
    targets = [*(f"s{i}" for i in range(1, states)), outcome]
    children = "".join(
        f"{indent}    s{i}: {{state: bench.Step, transitions: {{done: {target}}}}}\n"
        for i, target in enumerate(targets)
    )
    return f"{indent}machine:\n{indent}  initial: s0\n{indent}  states:\n{children}"


def _concurrency(count: int, child: str, outcome: str) -> str:
    children = "".join(f"      c{i}: {child}\n" for i in range(count))
    when = ", ".join(f"c{i}: {outcome}" for i in range(count))
    return f"  concurrency:\n    states:\n{children}    conditions:\n      - good: {{{when}}}\n"

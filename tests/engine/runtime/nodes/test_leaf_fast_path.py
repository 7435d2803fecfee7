"""A state that nothing is asked about takes a short way; whatever happens to it goes the way of every node."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import ClassVar

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event, NodeEntered
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.state import Context, Outcome, State
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import HEAD, run_document
from tests.engine.runtime.control.operate import operate

CHAIN = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, transitions: {a: two, b: bad, c: bad}}
      two: {state: test.Give, with: {after_s: 1}, transitions: {a: three, b: bad, c: bad}}
      three: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
"""
HANGING = "root:\n  machine:\n    initial: one\n    states:\n      one: {state: test.Hang, with: {cleanup_s: 2}}\n"


@pytest.mark.parametrize("begin_at_s", [None, 0.5, 2.0])
def test_who_watches_later_hears_the_numbers_and_times_of_who_watched_from_the_start(begin_at_s: float | None) -> None:
    everything = run_document(CHAIN).events
    heard: list[Event] = []

    async def main() -> None:
        run = Run(new_plan(parse_behavior(HEAD + CHAIN, file="t.yaml"), WITH_FLOW), run="r", bus=SkillBus(new_clock()))
        if begin_at_s is None:
            run.watch(heard.append)
        else:
            asyncio.get_running_loop().call_later(begin_at_s, run.watch, heard.append)
        await run.execute()

    run_virtual(main())
    assert heard == ([] if begin_at_s == 2.0 else list(everything[-len(heard) :]))
    assert (len(heard) == len(everything)) is (begin_at_s is None)


def test_a_stop_in_the_middle_lets_a_state_that_waits_since_its_first_step_clean_up() -> None:
    told = operate(HANGING, {1.0: lambda run: run.stop("enough")})
    assert told.result.status == "stopped"
    assert told.lines[-3:] == ["!root/one cleaned up", "-root/one preempted", "-root preempted"]
    assert told.events[-1].time_s == pytest.approx(3.0)


class TimesOut(State, frozen=True, kw_only=True):
    """Open a time limit in the first step, which holds in the steps after it."""

    state_name: ClassVar[str] = "test.TimesOut"
    outcomes: ClassVar[tuple[str, ...]] = ("late", "done")

    async def run(self, ctx: Context) -> Outcome:
        try:
            async with asyncio.timeout(1.0):
                await ctx.clock.sleep(0.5)
                await asyncio.get_running_loop().create_future()
        except TimeoutError:
            return Outcome("late")
        return Outcome("done")


def test_what_the_first_step_opens_belongs_to_the_task_that_goes_on() -> None:
    one = "{state: test.TimesOut, transitions: {late: good, done: bad}}"
    text = f"{HEAD}root:\n  machine:\n    initial: one\n    states:\n      one: {one}\n"
    plan = new_plan(parse_behavior(text, file="t.yaml"), {"test.TimesOut": TimesOut})

    async def main() -> tuple[str | None, float]:
        result = await Run(plan, run="r", bus=SkillBus(new_clock())).execute()
        return result.outcome, result.duration_s

    assert run_virtual(main()) == ("good", pytest.approx(1.0))


class Deaf(State, frozen=True, kw_only=True):
    """Take no notice of being cancelled."""

    state_name: ClassVar[str] = "test.Deaf"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        with suppress(asyncio.CancelledError):
            await asyncio.get_running_loop().create_future()
        return Outcome("done")


def test_a_loop_that_is_closed_over_a_state_that_takes_no_notice_enters_no_other() -> None:
    """Whoever closes a loop cancels all of its tasks, and asks nobody."""
    states = "deaf: {state: test.Deaf, transitions: {done: next}}, next: {state: test.Deaf, transitions: {done: good}}"
    text = f"{HEAD}root:\n  machine: {{initial: deaf, states: {{{states}}}}}\n"
    plan = new_plan(parse_behavior(text, file="t.yaml"), {"test.Deaf": Deaf})
    heard: list[Event] = []
    begun: list[object] = []

    async def main() -> None:
        run = Run(plan, run="r", bus=SkillBus(new_clock()))
        run.watch(heard.append)
        begun.append(asyncio.create_task(run.execute()))
        # Of virtual time: the state waits by then, and the loop is closed over it.
        await asyncio.sleep(0.1)

    run_virtual(main())
    assert [event.path for event in heard if isinstance(event, NodeEntered)] == ["root", "root/deaf"]

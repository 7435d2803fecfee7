"""A clean-up runs to its end, once, whatever is ordered before and meanwhile."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable
from typing import ClassVar

import pytest

from engine.event import MessageLogged
from engine.runtime.control import Breakpoint
from engine.runtime.run import Run
from engine.state import Context, Outcome, State
from tests.engine.run_document import ObservedRun
from tests.engine.runtime.control.operate import Act, operate, pause, resume
from tests.engine.runtime.control.turntable import BRAKING_S, Turn, Turntable

ONE = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Hang, with: {cleanup_s: 2}, transitions: {never: two}}
      two: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: good, c: bad}}
"""
NESTED = """
root:
  machine:
    initial: outer
    states:
      outer:
        machine:
          initial: inner
          states:
            inner: {state: test.Hang, with: {cleanup_s: 2}, transitions: {never: left}}
        transitions: {left: after}
      after: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: good, c: bad}}
"""
BESIDE = """
root:
  concurrency:
    states:
      left: {state: test.Hang, with: {cleanup_s: 2}}
      right: {state: test.Hang, with: {cleanup_s: 1}}
    conditions:
      - {good: {left: never}}
      - {bad: {right: never}}
"""


def stop(run: Run) -> None:
    run.stop("enough")


def force(path: str, outcome: str = "never") -> Act:
    return lambda run: run.control.force(path, outcome)


def repeat(path: str) -> Act:
    return lambda run: run.control.repeat(path)


def pause_before(path: str) -> Act:
    """Pause where a node is entered."""
    return lambda run: run.control.set_breakpoints([Breakpoint(path=path)])


def one(kind: type[State]) -> str:
    """`ONE` with another state in the place of the one that hangs."""
    return ONE.replace("test.Hang, with: {cleanup_s: 2}", kind.state_name)


def cleaned(told: ObservedRun) -> list[str]:
    """The clean-ups that came to their end."""
    return [line for line in told.lines if line.endswith("cleaned up")]


class ParkTable(State, frozen=True, kw_only=True):
    """Wait for ever; turn the table for a second to clean up."""

    state_name: ClassVar[str] = "test.ParkTable"
    outcomes: ClassVar[tuple[str, ...]] = ("never",)

    def resources(self) -> tuple[str, ...]:
        return ("table",)

    async def run(self, ctx: Context) -> Outcome:
        try:
            await ctx.perform(Turn(for_s=1000.0), to="table")
        finally:
            await ctx.perform(Turn(for_s=1.0), to="table")
            ctx.log("cleaned up")
        return Outcome("never")


@pytest.mark.parametrize("act", [stop, force("root/one"), repeat("root/one")])
def test_the_clean_up_of_a_paused_state_runs_to_its_end(act: Act) -> None:
    told = operate(ONE, {0.5: pause, 1.0: act, 10.0: stop})
    assert cleaned(told)[0] == "!root/one cleaned up"
    assert told.events[-1].time_s <= 12.0
    assert told.result.abandoned == ()


def test_a_stop_ends_a_paused_run_as_soon_as_it_has_cleaned_up() -> None:
    told = operate(ONE, {0.5: pause, 1.0: stop})
    assert (told.result.status, told.result.duration_s, len(cleaned(told))) == ("stopped", 3.0, 1)


def test_a_paused_clean_up_may_command_devices() -> None:
    told = operate(one(ParkTable), {0.5: pause, 2.0: stop}, prepare=Turntable, states={"test.ParkTable": ParkTable})
    assert (told.result.status, len(cleaned(told))) == ("stopped", 1)
    assert told.result.duration_s == pytest.approx(3.0, abs=2 * BRAKING_S)


def test_a_pause_stands_for_what_follows_a_forced_outcome() -> None:
    told = operate(ONE, {0.5: pause, 1.0: force("root/one"), 20.0: resume})
    assert (told.result.outcome, told.result.duration_s, len(cleaned(told))) == ("good", 21.0, 1)


@pytest.mark.parametrize("first", [force("root/one"), repeat("root/one")])
def test_the_same_order_given_twice_is_one_order(first: Act) -> None:
    told = operate(ONE, {1.0: first, 1.5: first, 6.0: force("root/one")})
    assert (told.result.status, told.result.outcome) == ("finished", "good")
    assert len(cleaned(told)) == sum("-root/one" in line for line in told.lines)


def test_of_two_orders_the_later_one_is_carried_out() -> None:
    told = operate(ONE, {1.0: repeat("root/one"), 1.5: force("root/one")})
    assert (told.result.outcome, told.result.duration_s, len(cleaned(told))) == ("good", 4.0, 1)


@pytest.mark.parametrize("first", [force("root/one"), repeat("root/one")])
def test_a_stop_lets_the_clean_up_of_an_order_end(first: Act) -> None:
    told = operate(ONE, {1.0: first, 1.5: stop, 1.75: stop})
    assert (told.result.status, told.result.duration_s, len(cleaned(told))) == ("stopped", 3.0, 1)


@pytest.mark.parametrize("first", ["root/outer/inner", "root/outer"])
def test_orders_of_a_node_and_of_one_inside_it_share_the_clean_up(first: str) -> None:
    """The outer one is carried out: what was ordered inside of it is over with it."""
    orders: dict[str, Callable[[Run], object]] = {
        "root/outer/inner": force("root/outer/inner"),
        "root/outer": force("root/outer", "left"),
    }
    second = next(path for path in orders if path != first)
    told = operate(NESTED, {1.0: orders[first], 1.5: orders[second]})
    assert (told.result.outcome, told.result.duration_s, len(cleaned(told))) == ("good", 4.0, 1)


def test_an_order_in_a_branch_that_is_preempted_for_another_reason_waits_for_its_clean_up() -> None:
    """`right` ends while `left` still cleans up for an order: the container takes it and does not cut it."""
    told = operate(BESIDE, {1.0: repeat("root/left"), 1.5: force("root/right")})
    assert sorted(cleaned(told)) == ["!root/left cleaned up", "!root/right cleaned up"]
    assert (told.result.status, told.result.outcome) == ("finished", "bad")


def test_a_stop_waits_for_a_branch_that_cleans_up_for_an_order() -> None:
    told = operate(BESIDE, {1.0: force("root/left"), 1.5: stop})
    assert sorted(cleaned(told)) == ["!root/left cleaned up", "!root/right cleaned up"]
    assert (told.result.status, told.result.duration_s) == ("stopped", 3.0)


def test_a_clean_up_that_a_pause_holds_is_not_given_up() -> None:
    """Nobody ordered its end, so the pause holds it; the patience with it stands still meanwhile."""
    text = ONE.replace("transitions: {never: two}", "timeout: {after: 1, to: two}, transitions: {never: two}")
    told = operate(text, {1.5: pause, 100.0: resume})
    assert told.result.abandoned == ()
    assert (told.result.outcome, told.result.duration_s, len(cleaned(told))) == ("good", 102.5, 1)


def test_only_the_clean_up_for_an_order_is_let_end_in_a_pause_and_not_a_later_one() -> None:
    """Repeated, the node runs again; then its time is over, in a pause."""
    text = ONE.replace("transitions: {never: two}", "timeout: {after: 2, to: two}, transitions: {never: two}")
    told = operate(text, {0.5: pause, 1.0: repeat("root/one"), 3.5: resume, 6.0: pause, 100.0: resume})
    ended = [
        event.time_s for event in told.events if isinstance(event, MessageLogged) and event.message == "cleaned up"
    ]
    assert ended == [3.0, 101.5]


def test_a_clean_up_that_a_pause_holds_beside_a_step_is_not_given_up() -> None:
    """The step frees the other branch and the container around both, whose time is then over."""
    text = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left: {state: test.Hang, with: {cleanup_s: 2}}
            right:
              machine:
                initial: first
                states:
                  first: {state: test.Give, with: {after_s: 1}, transitions: {a: last, b: last, c: last}}
                  last: {state: test.Give, with: {after_s: 9}, transitions: {a: out, b: out, c: out}}
          conditions: [{a: {right: out}}, {a: {left: never}}]
        timeout: {after: 2, to: late}
        transitions: {a: good}
      late: {state: test.Give, transitions: {a: good, b: good, c: bad}}
"""

    def step(run: Run) -> None:
        run.control.step("into", "root/both/right")

    told = operate(text, {0.5: pause_before("root/both/right/last"), 10.0: step, 100.0: resume})
    assert told.result.abandoned == ()
    assert (told.result.outcome, len(cleaned(told))) == ("good", 1)


class Defiant(State, frozen=True, kw_only=True):
    """Take back what it was asked, and end as if nothing had been."""

    state_name: ClassVar[str] = "test.Defiant"
    outcomes: ClassVar[tuple[str, ...]] = ("never",)

    async def run(self, ctx: Context) -> Outcome:
        try:
            await ctx.clock.sleep(1000.0)
        except asyncio.CancelledError:
            task = asyncio.current_task()
            assert task is not None
            task.uncancel()
        return Outcome("never")


def test_a_state_that_takes_its_cancel_back_is_stopped_all_the_same() -> None:
    told = operate(one(Defiant), {1.0: stop}, states={"test.Defiant": Defiant})
    assert (told.result.status, told.result.duration_s) == ("stopped", 1.0)


class Patient(State, frozen=True, kw_only=True):
    """Give up on something by a time-out of its own; cancelled at that very instant it must hear of it."""

    state_name: ClassVar[str] = "test.Patient"
    outcomes: ClassVar[tuple[str, ...]] = ("never",)

    async def run(self, ctx: Context) -> Outcome:
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(1.0):
                await ctx.clock.sleep(1000.0)
        await ctx.clock.sleep(1000.0)
        return Outcome("never")


def test_a_stop_at_the_instant_of_a_time_out_inside_a_state_is_heard() -> None:
    told = operate(one(Patient), {1.0: stop}, states={"test.Patient": Patient})
    assert (told.result.status, told.result.duration_s) == ("stopped", 1.0)


@pytest.mark.parametrize("order", [stop, force("root/one"), repeat("root/one")], ids=["stop", "force", "repeat"])
def test_an_order_lets_a_clean_up_for_a_time_out_end_that_a_pause_holds(order: Act) -> None:
    """The state runs in a task inside that of its time-out, which cleans up already."""
    text = ONE.replace("cleanup_s: 2}", "cleanup_s: 2}, timeout: {after: 1, to: two}")
    told = operate(text, {2.0: pause, 3.0: order, 30.0: resume, 40.0: stop})
    first = next(event for event in told.events if isinstance(event, MessageLogged) and event.message == "cleaned up")
    assert first.time_s == pytest.approx(4.0)
    assert told.result.abandoned == ()

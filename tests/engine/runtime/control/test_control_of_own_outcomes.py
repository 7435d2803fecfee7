"""States that take part in control: they offer outcomes, change their minds, and come to rest themselves."""

from __future__ import annotations

import asyncio
from typing import ClassVar

import pytest

from engine.event import GateReached, MessageLogged, OutcomeRequested, OutcomeWithdrawn, PauseConfirmed
from engine.runtime.control import LossPolicy
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.state import Context, Outcome, State
from tests.engine.runtime.control.operate import Act, operate


class Propose(State, frozen=True, kw_only=True):
    """Offer `a` for a while; when nobody agrees, end with `b` by itself."""

    state_name: ClassVar[str] = "test.Propose"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b")
    for_s: float = 5.0

    async def run(self, ctx: Context) -> Outcome:
        offer = asyncio.create_task(ctx.offer("a"))
        patience = asyncio.create_task(ctx.clock.sleep(self.for_s))
        try:
            await asyncio.wait({offer, patience}, return_when=asyncio.FIRST_COMPLETED)
            return Outcome("a" if offer.done() else "b")
        finally:
            for task in (offer, patience):
                task.cancel()
            await asyncio.wait({offer, patience})


class Hum(State, frozen=True, kw_only=True):
    """Hum until told that it is enough; be silent while paused."""

    state_name: ClassVar[str] = "test.Hum"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        await ctx.clock.sleep(4.0)
        return Outcome("done")

    async def on_pause(self, ctx: Context) -> None:
        ctx.log("silent")

    async def on_resume(self, ctx: Context) -> None:
        ctx.log("humming")


PROPOSE = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Propose, autonomy: {a: high, b: off}, transitions: {a: good, b: bad}}
"""
STATES = {"test.Propose": Propose, "test.Hum": Hum}
DEMANDED = RunOptions(autonomy="low", demand_operator=True)


def test_an_offered_outcome_that_is_agreed_to_is_asked_for_once() -> None:
    told = operate(PROPOSE, {2.0: lambda run: run.control.answer("root/one")}, supervision=DEMANDED, states=STATES)
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(2.0))
    assert [e.outcome for e in told.events if isinstance(e, OutcomeRequested)] == ["a"]


def test_a_state_that_changes_its_mind_withdraws_what_it_offered() -> None:
    told = operate(PROPOSE, {}, supervision=DEMANDED, states=STATES)
    assert (told.result.outcome, told.result.duration_s) == ("bad", pytest.approx(5.0))
    asked = [(type(e), e.time_s) for e in told.events if isinstance(e, OutcomeRequested | OutcomeWithdrawn)]
    assert asked == [(OutcomeRequested, 0.0), (OutcomeWithdrawn, 5.0)]


def test_with_enough_autonomy_an_offer_passes_at_once() -> None:
    at = RunOptions(autonomy="full", demand_operator=True)
    told = operate(PROPOSE, {}, supervision=at, states=STATES)
    assert (told.result.outcome, told.result.duration_s) == ("good", 0.0)


LATE = "test.Late, autonomy: {a: high}, transitions: {a: good}"


class Late(State, frozen=True, kw_only=True):
    """Offer `a` after a second, and end with it."""

    state_name: ClassVar[str] = "test.Late"
    outcomes: ClassVar[tuple[str, ...]] = ("a",)

    async def run(self, ctx: Context) -> Outcome:
        await asyncio.sleep(1.0)
        await ctx.offer("a")
        ctx.log("offered")
        return Outcome("a")


def test_an_offer_that_asks_nobody_passes_in_a_pause_and_the_exit_waits() -> None:
    text = PROPOSE.replace("test.Propose, autonomy: {a: high, b: off}, transitions: {a: good, b: bad}", LATE)
    acts: dict[float, Act] = {0.5: lambda run: run.control.pause(), 3.0: lambda run: run.control.resume()}
    told = operate(text, acts, supervision=RunOptions(autonomy="low"), states={"test.Late": Late})
    assert [e.time_s for e in told.events if isinstance(e, MessageLogged)] == [1.0]
    assert [(e.point, e.time_s) for e in told.events if isinstance(e, GateReached)] == [("after", 1.0)]
    assert told.result.duration_s == pytest.approx(3.0)


def test_a_state_is_notified_of_pause_and_resume() -> None:
    text = "root: {machine: {initial: one, states: {one: {state: test.Hum, transitions: {done: good}}}}}"
    told = operate(text, {1.0: lambda run: run.control.pause(), 3.0: lambda run: run.control.resume()}, states=STATES)
    assert [line for line in told.lines if line.startswith("!")] == ["!root/one silent", "!root/one humming"]
    assert told.result.duration_s == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("policy", "status", "duration_s"),
    [("hold", "finished", 21.0), ("continue", "finished", 4.0), ("stop", "stopped", 3.0)],
)
def test_a_lost_operator_holds_continues_or_stops_after_the_time_out(
    policy: LossPolicy, status: str, duration_s: float
) -> None:
    text = "root: {machine: {initial: one, states: {one: {state: test.Hum, transitions: {done: good}}}}}"
    at = RunOptions(loss_policy=policy, loss_timeout_s=2.0)

    def back(run: Run) -> None:
        run.control.attach_operator()
        run.control.resume()

    acts: dict[float, Act] = {
        0.5: lambda run: run.control.attach_operator(),
        1.0: lambda run: run.control.lose_operator(),
        20.0: back,
    }
    told = operate(text, acts, supervision=at, states=STATES)
    assert (told.result.status, told.result.duration_s) == (status, pytest.approx(duration_s))
    assert bool([e for e in told.events if isinstance(e, PauseConfirmed)]) == (policy == "hold")
    assert not [e for e in told.events if isinstance(e, GateReached)]

"""The operator of a run: there, gone, or lost; what is shown of the run, and what is refused."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.errors import ControlError
from engine.event import (
    Event,
    MessageLogged,
    OperatorChanged,
    OperatorCommanded,
    OutcomeRequested,
    PauseConfirmed,
    RunEnded,
)
from engine.runtime.control import Breakpoint
from engine.runtime.control.control import ControlView, LossPolicy
from engine.runtime.control.gate import GateWait
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from tests.engine.run_document import ObservedRun, plan_of
from tests.engine.runtime.control.operate import Act, operate, pause, resume

ASKS = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, with: {after_s: 2}, autonomy: {a: high}, transitions: {a: two, b: bad, c: bad}}
      two: {state: test.Give, with: {after_s: 20}, transitions: {a: good, b: bad, c: bad}}
"""


def attach(run: Run) -> None:
    """Somebody is there."""
    run.control.attach_operator()


def detach(run: Run) -> None:
    """They went."""
    run.control.detach_operator()


def lose(run: Run) -> None:
    """Their connection broke."""
    run.control.lose_operator()


def answer(run: Run) -> None:
    """Let the first outcome pass."""
    run.control.answer("root/one")


def end(run: Run) -> None:
    """Enough is seen."""
    run.stop("enough")


def step(run: Run) -> None:
    """Let one branch go on to its next gate."""
    run.control.step()


def lock(run: Run) -> None:
    """Keep the outcome of the first."""
    run.control.lock("root/one")


def options(policy: LossPolicy, *, demanded: bool = False) -> RunOptions:
    """Return options of a run that asks about `root/one`, and waits for its operator for 3 s."""
    return RunOptions(autonomy="high", loss_policy=policy, loss_timeout_s=3.0, demand_operator=demanded)


def operators(told: ObservedRun) -> list[tuple[float, str]]:
    """Return when the operator was what."""
    return [(event.time_s, event.status) for event in told.events if isinstance(event, OperatorChanged)]


def commands(told: ObservedRun) -> list[tuple[float, str]]:
    """Return when what was commanded."""
    return [(event.time_s, event.command) for event in told.events if isinstance(event, OperatorCommanded)]


def test_a_run_whose_operator_is_lost_is_held_after_a_while() -> None:
    """Also when it goes on by itself meanwhile; who comes back lets it go on."""
    told = operate(
        ASKS, {0.5: attach, 1.0: lose, 10.0: attach, 11.0: resume, 12.0: answer}, supervision=options("hold")
    )
    assert operators(told)[:3] == [(0.5, "attached"), (1.0, "lost"), (10.0, "attached")]
    assert commands(told)[:3] == [(4.0, "pause"), (11.0, "resume"), (12.0, "answer")]


def test_a_run_whose_operator_is_lost_goes_on_without_questions_if_so_configured() -> None:
    told = operate(ASKS, {0.5: attach, 1.0: lose}, supervision=options("continue"))
    assert [event.time_s for event in told.events if isinstance(event, OutcomeRequested)] == [2.0]
    assert (told.result.outcome, told.result.duration_s, commands(told)) == ("good", 24.0, [])


def test_a_run_that_demands_an_operator_asks_also_when_it_was_lost() -> None:
    told = operate(ASKS, {0.5: attach, 1.0: lose, 9.0: answer}, supervision=options("continue", demanded=True))
    assert commands(told)[0] == (9.0, "answer")


def test_a_run_whose_operator_is_lost_is_stopped_if_so_configured() -> None:
    told = operate(ASKS, {0.5: attach, 1.0: lose}, supervision=options("stop"))
    assert (told.result.status, told.result.duration_s) == ("stopped", 4.0)
    assert "the operator was lost" in str(told.events)


@pytest.mark.parametrize("back", [attach, detach])
@pytest.mark.parametrize("policy", ["hold", "stop"])
def test_an_operator_who_is_back_in_time_was_not_lost(back: Act, policy: LossPolicy) -> None:
    """Or has taken leave properly."""
    acts: dict[float, Act] = {0.5: attach, 1.0: lose, 3.9: back, 5.0: detach}
    told = operate(ASKS, acts, supervision=options(policy))
    assert (told.result.outcome, told.result.duration_s, commands(told)) == (
        "good",
        pytest.approx(25.0 if back is attach else 23.9),
        [],
    )


def test_nobody_is_lost_who_was_not_there() -> None:
    told = operate(ASKS, {0.5: lose, 1.0: attach, 1.2: detach, 1.5: lose}, supervision=options("stop"))
    assert operators(told) == [(1.0, "attached"), (1.2, "detached")]
    assert (told.result.outcome, told.result.duration_s) == ("good", 22.0)


def test_what_is_shown_of_a_run_is_how_it_stands() -> None:
    seen: list[ControlView] = []

    def look(run: Run) -> None:
        seen.append(run.control.view())

    def prepare(run: Run) -> None:
        run.control.lock("root/two")
        run.control.set_autonomy("low")
        run.control.set_breakpoints([Breakpoint(path="root/two")])

    acts: dict[float, Act] = {0.5: look, 1.0: attach, 1.1: prepare, 1.2: pause, 5.0: look, 6.0: step, 6.5: look}
    operate(ASKS, {**acts, 20.0: end}, supervision=options("stop"))
    assert seen[0] == ControlView(
        paused=False, confirmed=False, cannot=(), waiting=(), locks=(), breakpoints=(), autonomy="high",
        operator="none", active=("root", "root/one"), loss_policy="stop", loss_timeout_s=3.0,
    )  # fmt: skip
    held = seen[1]
    assert (held.paused, held.confirmed, held.locks, held.autonomy) == (True, True, ("root/two",), "low")
    assert (held.operator, held.breakpoints, held.stepping) == ("attached", (Breakpoint(path="root/two"),), False)
    assert (seen[2].paused, seen[2].confirmed, seen[2].stepping) == (True, False, True)


def test_a_breakpoint_that_matches_nothing_is_kept_and_named() -> None:
    """Also one after an outcome; those that match are not mentioned."""

    def set_them(run: Run) -> None:
        run.control.set_breakpoints(
            [
                Breakpoint(path="root/tow"),
                Breakpoint(path="root/two", when="after", outcomes=("a",)),
                Breakpoint(path="root/o*", enabled=True),
            ]
        )
        assert len(run.control.view().breakpoints) == 3

    told = operate(ASKS, {0.5: set_them, 3.0: end})
    warnings = [event.message for event in told.events if isinstance(event, MessageLogged) and event.level == "warning"]
    assert warnings == ["the breakpoint at root/tow matches no node; did you mean root/two or root/one or root?"]


def test_a_step_in_a_branch_where_nobody_waits_is_refused() -> None:
    said: list[str] = []

    def wrong(run: Run) -> None:
        with pytest.raises(ControlError) as refused:
            run.control.step("into", "root/three")
        said.append(str(refused.value))

    operate(ASKS, {0.5: pause, 30.0: wrong, 31.0: end})
    assert said[0].startswith("root/three: no node waits there")


def test_every_pause_is_confirmed_once() -> None:
    told = operate(ASKS, {0.5: pause, 1.0: resume, 1.5: pause, 1.6: pause, 2.0: resume})
    assert [event.time_s for event in told.events if isinstance(event, PauseConfirmed)] == [0.5, 1.5, 1.6]


def test_who_waits_at_the_gate_is_shown_with_the_reasons() -> None:
    seen: list[tuple[GateWait, ...]] = []

    def look(run: Run) -> None:
        seen.append(run.control.view().waiting)

    acts: dict[float, Act] = {0.5: attach, 1.0: lock, 3.0: look, 4.0: pause, 5.0: look}
    operate(ASKS, {**acts, 6.0: end}, supervision=options("hold"))
    wait = GateWait(path="root/one", visit=1, point="after", outcome="a", required="high", reasons=("lock", "autonomy"))
    assert seen == [(wait,), (replace(wait, reasons=("pause", "lock", "autonomy")),)]


def test_a_run_says_in_a_word_whom_it_waits_for() -> None:
    """A question comes before a pause, a pause before a lock."""
    seen: list[str] = []

    def look(run: Run) -> None:
        seen.append(run.control.view().waits)

    before: dict[float, Act] = {0.5: attach, 1.0: lock, 1.5: look, 3.0: look, 4.0: pause, 4.5: look}
    operate(ASKS, {**before, 5.0: answer, 5.5: look, 6.0: resume, 6.5: look, 7.0: end}, supervision=options("hold"))
    assert seen == ["", "asks", "asks", "paused", "locked"]


def test_who_has_commanded_sees_what_came_of_it_at_once() -> None:
    seen: list[tuple[str, ...]] = []

    async def force(run: Run) -> None:
        run.control.force("root/one", "a")
        await run.control.settled()
        seen.append(run.control.view().active)

    operate(ASKS, {1.0: force})
    assert seen == [("root", "root/two")]


def test_an_operator_who_is_lost_just_before_the_end_changes_nothing_after_it() -> None:
    """The events of a run end with its end."""
    events: list[Event] = []

    async def main() -> None:
        async with SkillBus(new_clock()) as bus:
            run = Run(plan_of(ASKS), run="r1", bus=bus, supervision=options("hold"))
            run.watch(events.append)
            loop = asyncio.get_running_loop()
            for at_s, act in ((1.0, attach), (2.5, answer), (21.5, lose)):
                loop.call_at(at_s, act, run)
            await run.execute()
            await asyncio.sleep(60.0)

    run_virtual(main())
    assert (type(events[-1]), events[-1].time_s) == (RunEnded, 22.5)

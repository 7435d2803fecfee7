"""Checks in front of a running action are asked again: when what they read changes, and at their period."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ClassVar

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.errors import DocumentError
from engine.event import Event, NodeExited, ServiceCalled
from engine.journal import decode_event, encode_event
from engine.messages import Message
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.skill import Service
from engine.state import Context, Outcome, State
from states.flow.decide import Decide
from states.flow.wait import Wait
from tests.engine.runtime.tree.run_tree import HEAD, ObservedRun
from tests.engine.runtime.tree.scripted_states import CATALOGUE, COUNTS

HELD_UNTIL_S = 1.05


class Held(Service[bool], frozen=True, kw_only=True):
    """Ask a gripper whether it holds something."""


class Door(Message, frozen=True, kw_only=True):
    """Whether a door is closed."""

    closed: bool


class CheckHeld(State, frozen=True, kw_only=True):
    """Ask the service."""

    state_name: ClassVar[str] = "test.CheckHeld"
    outcomes: ClassVar[tuple[str, ...]] = ("held", "lost")
    success: ClassVar[tuple[str, ...]] = ("held",)
    observes: ClassVar[bool] = True

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("held" if await ctx.call(Held(), to="gripper") else "lost")


class CheckUndeclared(CheckHeld, frozen=True, kw_only=True):
    """The same of a class that does not say that it only observes."""

    state_name: ClassVar[str] = "test.CheckUndeclared"
    observes: ClassVar[bool] = False


class CheckDoor(State, frozen=True, kw_only=True):
    """Read the topic."""

    state_name: ClassVar[str] = "test.CheckDoor"
    outcomes: ClassVar[tuple[str, ...]] = ("closed", "open")
    success: ClassVar[tuple[str, ...]] = ("closed",)

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("closed" if (await ctx.latest("door", Door)).closed else "open")


class CheckRandom(CheckHeld, frozen=True, kw_only=True):
    """Take a number that others would be given otherwise, and fail at the third time."""

    state_name: ClassVar[str] = "test.CheckRandom"
    observes: ClassVar[bool] = False

    async def run(self, ctx: Context) -> Outcome:
        ctx.random()
        COUNTS[ctx.path] = COUNTS.get(ctx.path, 0) + 1
        return Outcome("held" if COUNTS[ctx.path] < 3 else "lost")


STATES = {each.state_name: each for each in (CheckHeld, CheckUndeclared, CheckDoor, CheckRandom, Decide, Wait)}


def _plan(tree: str, *, head: str = "") -> Plan:
    text = f"{HEAD}{head}\nroot:\n  tree: {tree}\n"
    return new_plan(parse_behavior(text, file="test.yaml"), {**CATALOGUE, **STATES})


def _events_of(
    plan: Plan,
    *,
    held: Callable[[float], bool] = lambda now_s: now_s < HELD_UNTIL_S,
    answer_after_s: float = 0.0,
    do: Callable[[Run, SkillBus], None] = lambda run, bus: None,
    polling_limit: int = 20_000,
    checkpoint: Checkpoint | None = None,
) -> ObservedRun:
    COUNTS.clear()
    events: list[Event] = []

    async def main() -> RunResult:
        async with SkillBus(new_clock()) as bus:

            async def answer(_: Held) -> bool:
                await bus.clock.sleep(answer_after_s)
                return held(bus.clock.now_s())

            bus.advertise_service(Held, answer, namespace="gripper")
            bus.topic("door", Door).publish(Door(closed=True))
            run = Run(plan, run="r", bus=bus, polling_limit=polling_limit, checkpoint=checkpoint)
            run.watch(events.append)
            do(run, bus)
            return await run.execute()

    return ObservedRun(run_virtual(main()), tuple(events))


def _left(told: ObservedRun, name: str) -> list[tuple[float, bool]]:
    return [(e.time_s, e.preempted) for e in told.events if isinstance(e, NodeExited) and e.path.endswith(f"/{name}")]


CARRY = "{state: test.Act, name: carry, with: {script: [[5, true]]}}"


def test_a_part_that_is_dropped_is_not_carried_on() -> None:
    """The check is asked each 0.1 s; what stands behind it is halted, and the log tells of the one that mattered."""
    told = _events_of(_plan(f"{{sequence: {{memory: false, children: [{{state: test.CheckHeld}}, {CARRY}]}}}}"))
    assert (told.result.outcome, _left(told, "carry")) == ("failure", [(1.1, True)])
    assert told.entered("CheckHeld") == [0.0, 1.1]
    assert len([event for event in told.events if isinstance(event, ServiceCalled)]) == 2


def test_its_period_can_be_given() -> None:
    """With `every` beside it, and for a class that does not say that it observes, too; that one is run each time."""
    for check in ("CheckHeld", "CheckUndeclared"):
        tree = f"{{sequence: {{memory: false, children: [{{state: test.{check}, every: 500 ms}}, {CARRY}]}}}}"
        told = _events_of(_plan(tree))
        assert _left(told, "carry") == [(1.5, True)]
        assert told.entered(check) == ([0.0, 1.5] if check == "CheckHeld" else [0.0, 0.5, 1.0, 1.5])


def test_a_selector_goes_back_to_what_stands_first() -> None:
    """Also through a decorator, and below parts that have memory."""
    tree = f"""
    sequence:
      - selector:
          memory: false
          children: [{{inverter: {{child: {{state: test.CheckHeld}}}}}}, {CARRY}]
      - {{state: test.Act, name: after, with: {{script: [[1, true]]}}}}
    """
    told = _events_of(_plan(f"\n{tree}"))
    assert told.result.outcome == "success"
    assert (_left(told, "carry"), told.entered("after")) == ([(1.1, True)], [1.1])


def test_what_has_memory_is_not_asked_again() -> None:
    """A part that went before in a sequence with memory is over."""
    told = _events_of(_plan(f"{{sequence: [{{state: test.CheckHeld}}, {CARRY}]}}"))
    assert (told.result.outcome, _left(told, "carry")) == ("success", [(5.0, False)])


DECIDE = "{state: flow.Decide, name: check, with: {when: '${value < 5}'}}"


WRITES = f"""
    sequence:
      memory: false
      children:
        - {DECIDE}
        - machine:
            initial: writer
            states:
              writer: {{state: test.Write, with: {{after_s: 1, value: 9}}, out: {{value: value}},
                        transitions: {{done: more}}}}
              more: {{state: flow.Wait, with: {{duration_s: 3}}, transitions: {{done: done}}}}
"""
NUMBER = "userdata: {value: 0}"


def test_a_check_that_reads_userdata_is_asked_when_it_is_written() -> None:
    """At that very instant, and never otherwise."""
    told = _events_of(_plan(f"\n{WRITES}", head=NUMBER))
    assert told.result.outcome == "failure"
    assert told.entered("check") == [0.0, 1.0]
    assert _left(told, "more") == [(1.0, True)]


def test_what_changed_before_a_crash_is_met_after_it() -> None:
    """Wherever the engine died: also between the write and the tick that it makes due."""
    plan = _plan(f"\n{WRITES}", head=NUMBER)
    whole = _events_of(plan)
    for count in range(1, len(whole.events)):
        known = [decode_event(encode_event(event)) for event in whole.events[:count]]
        rest = _events_of(plan, checkpoint=ResumableState(plan, run="r").read(known).checkpoint())
        assert rest.result.outcome == "failure", whole.events[count - 1]
        assert not [left for left in _left(rest, "more") if not left[1]], whole.events[count - 1]


def test_a_check_that_reads_a_topic_is_asked_when_that_has_a_new_message() -> None:
    """A message that changes nothing leaves no trace."""

    def publish(run: Run, bus: SkillBus) -> None:
        loop = asyncio.get_running_loop()
        door = bus.topic("door", Door)
        for at_s, closed in ((1.0, True), (2.0, True), (3.0, False)):
            loop.call_at(at_s, door.publish, Door(closed=closed))

    told = _events_of(
        _plan(f"{{sequence: {{memory: false, children: [{{state: test.CheckDoor}}, {CARRY}]}}}}"), do=publish
    )
    assert (told.result.outcome, _left(told, "carry")) == ("failure", [(3.0, True)])
    assert told.entered("CheckDoor") == [0.0, 3.0]


def test_the_action_is_not_begun_anew_by_checks_that_say_the_same() -> None:
    """Two actions in a row, of which the first would be run again by a tick."""
    tree = f"""
    sequence:
      memory: false
      children:
        - {{state: test.CheckHeld}}
        - {{state: test.Act, name: first, with: {{script: [[1, true]]}}}}
        - {CARRY}
    """
    told = _events_of(_plan(f"\n{tree}"), held=lambda now_s: now_s < 4.05)
    assert told.entered("first") == [0.0]
    assert _left(told, "carry") == [(4.1, True)]


def test_an_answer_that_was_observed_is_the_one_that_counts() -> None:
    """A gripper that says `lost` once is believed: the tick does not ask it a second time."""
    asked: list[float] = []

    def held(now_s: float) -> bool:
        asked.append(now_s)
        return len(asked) != 4

    told = _events_of(
        _plan(f"{{sequence: {{memory: false, children: [{{state: test.CheckHeld}}, {CARRY}]}}}}"), held=held
    )
    assert (told.result.outcome, _left(told, "carry"), len(asked)) == ("failure", [(0.3, True)], 4)


def test_a_slow_answer_holds_up_nothing() -> None:
    """What ends meanwhile is seen at once; an answer of more than a second counts as RUNNING, as in a tick."""
    plan = _plan(
        "{sequence: {memory: false, children: [{state: test.CheckHeld}, "
        "{state: test.Act, name: carry, with: {script: [[1.5, true]]}}]}}"
    )
    told = _events_of(plan, held=lambda now_s: True, answer_after_s=0.8)
    assert _left(told, "carry")[0] == (2.3, False)


def test_what_only_running_tells_is_run() -> None:
    """A state that takes random numbers is not observed, for the next one would be given others."""
    tree = f"{{sequence: {{memory: false, children: [{{state: test.CheckRandom, every: 1 s}}, {CARRY}]}}}}"
    told = _events_of(_plan(tree))
    assert told.entered("CheckRandom") == [0.0, 1.0, 2.0]
    assert _left(told, "carry") == [(2.0, True)]


def test_nothing_is_asked_during_a_pause() -> None:
    """Nor is what was lost meanwhile overlooked after it."""

    def pause(run: Run, bus: SkillBus) -> None:
        loop = asyncio.get_running_loop()
        loop.call_at(1.0, run.control.pause)
        loop.call_at(61.0, run.control.resume)

    asked: list[float] = []

    def held(now_s: float) -> bool:
        asked.append(now_s)
        return now_s < 30.0

    told = _events_of(
        _plan(f"{{sequence: {{memory: false, children: [{{state: test.CheckHeld}}, {CARRY}]}}}}"), held=held, do=pause
    )
    assert told.result.outcome == "failure"
    assert not [at_s for at_s in asked if 1.0 < at_s < 61.0]
    assert _left(told, "carry")[0][0] == pytest.approx(61.0, abs=0.11)


def test_a_tree_that_only_asks_for_ever_is_named_in_virtual_time() -> None:
    """A wait of an hour is none: something is to come."""
    tree = """
    sequence:
      memory: false
      children:
        - {state: test.CheckHeld}
        - machine:
            initial: wait
            states: {wait: {state: test.Never, transitions: {done: done}}}
    """

    class Never(State, frozen=True, kw_only=True):
        state_name: ClassVar[str] = "test.Never"
        outcomes: ClassVar[tuple[str, ...]] = ("done",)

        async def run(self, ctx: Context) -> Outcome:
            await ctx.next_message("door", Door)
            return Outcome("done")

    text = f"{HEAD}\nroot:\n  tree: \n{tree}\n"
    plan = new_plan(parse_behavior(text, file="test.yaml"), {**CATALOGUE, **STATES, "test.Never": Never})
    told = _events_of(plan, held=lambda now_s: True, polling_limit=1_000)
    assert told.result.status == "errored"
    assert any("ticked sequence/CheckHeld again 1000 times" in line for line in told.why), told.why
    hour = "{state: test.Act, name: carry, with: {script: [[3600, true]]}}"
    told = _events_of(
        _plan(f"{{sequence: {{memory: false, children: [{{state: test.CheckHeld}}, {hour}]}}}}"),
        held=lambda now_s: True,
        polling_limit=1_000,
    )
    assert told.result.outcome == "success"


@pytest.mark.parametrize(
    ("node", "message"),
    [
        ("{state: test.CheckHeld, every: 0}", "at least 1 ms"),
        ("{inverter: {child: {state: test.CheckHeld}}, every: 1}", "`every` goes with a check"),
    ],
)
def test_a_period_that_makes_no_sense_is_refused(node: str, message: str) -> None:
    """Beside a composite, and below what a clock can tell."""
    with pytest.raises(DocumentError, match=message):
        _plan(f"{{sequence: {{memory: false, children: [{node}, {CARRY}]}}}}")


async def test_it_does_on_a_real_clock_too() -> None:
    """The check is asked while the action runs."""
    text = f"""{HEAD}
root:
  tree:
    sequence:
      memory: false
      children:
        - {{state: test.CheckHeld, every: 1 ms}}
        - {{state: test.Act, name: carry, with: {{script: [[60, true]]}}}}
"""
    plan = new_plan(parse_behavior(text, file="test.yaml"), {**CATALOGUE, **STATES})
    asked = 0
    async with SkillBus(new_clock()) as bus:

        async def answer(_: Held) -> bool:
            nonlocal asked
            asked += 1
            return asked < 5

        bus.advertise_service(Held, answer, namespace="gripper")
        result = await Run(plan, run="r", bus=bus).execute()
    assert (result.outcome, asked) == ("failure", 5)


def test_a_tree_that_polls_for_ever_in_virtual_time_is_named() -> None:
    """A check under `condition`, ticked again and again, of which nobody can change the answer any more."""
    tree = "{condition: {status: success, every: 100 ms, child: {state: test.CheckHeld}}}"
    told = _events_of(_plan(tree), held=lambda now_s: False, polling_limit=2_000)
    assert told.result.status == "errored"
    assert any("ticked condition/CheckHeld again 2000 times" in line for line in told.why), told.why
    told = _events_of(_plan(tree), held=lambda now_s: now_s > 150.0, polling_limit=2_000)
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(150.1))


@pytest.mark.parametrize(
    "check", ["{state: test.CheckHeld}", "{inverter: {child: {inverter: {child: {state: test.CheckHeld}}}}}"]
)
def test_the_condition_of_a_loop_watches_over_what_it_runs(check: str) -> None:
    """Asked as checks are in a composite without memory; what it ends makes room for the other branch."""
    other = "{state: test.Act, name: other, with: {script: [[1, true]]}}"
    told = _events_of(_plan(f"{{while_do_else: {{while: {check}, do: {CARRY}, else: {other}}}}}"))
    assert (told.result.outcome, _left(told, "carry")) == ("success", [(1.1, True)])
    assert (told.entered("CheckHeld"), told.entered("other")) == ([0.0, 1.1, 2.1], [1.1])
    assert len([event for event in told.events if isinstance(event, ServiceCalled)]) == 3

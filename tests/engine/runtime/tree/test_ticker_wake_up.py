"""A tree is ticked when something woke it, and not otherwise; a check may ask a service within a tick."""

from __future__ import annotations

import asyncio
from typing import ClassVar

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event, NodeEntered, NodeExited
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.skill import Service
from engine.state import Context, Outcome, State
from tests.engine.runtime.tree.run_tree import HEAD, run_plan, tree_plan
from tests.engine.runtime.tree.scripted_states import CATALOGUE

HOUR_S = 3600.0


class Held(Service[bool], frozen=True, kw_only=True):
    """Ask a gripper whether it holds something."""


class CheckHeld(State, frozen=True, kw_only=True):
    """Ask the service, `times` times."""

    state_name: ClassVar[str] = "test.CheckHeld"
    outcomes: ClassVar[tuple[str, ...]] = ("held", "lost")
    success: ClassVar[tuple[str, ...]] = ("held",)
    times: int = 1

    async def run(self, ctx: Context) -> Outcome:
        answers = [await ctx.call(Held(), to="gripper") for _ in range(self.times)]
        return Outcome("held" if all(answers) else "lost")


def _watching(check: str) -> Plan:
    """Plan a tree that moves for three seconds while a check says so, with another leaf that ends at 1 and 2."""
    text = f"""{HEAD}
root:
  tree:
    parallel:
      policy: [sequence]
      children:
        - sequence:
            memory: false
            children: [{check}, {{state: test.Act, name: move, with: {{script: [[3, true]]}}}}]
        - repeat: {{times: 2, child: {{state: test.Act, name: beside, with: {{script: [[1, true]]}}}}}}
"""
    catalogue = {**CATALOGUE, "test.CheckHeld": CheckHeld}
    return new_plan(parse_behavior(text, file="test.yaml"), catalogue)


async def _run(plan: Plan, *, answer_after_s: float, stop_at_s: float | None = None) -> tuple[RunResult, list[Event]]:
    events: list[Event] = []
    async with SkillBus(new_clock()) as bus:

        async def held(_: Held) -> bool:
            await bus.clock.sleep(answer_after_s)
            return True

        bus.advertise_service(Held, held, namespace="gripper")
        run = Run(plan, run="r", bus=bus)
        run.watch(events.append)
        if stop_at_s is not None:
            asyncio.get_running_loop().call_later(stop_at_s, run.stop, "test")
        return await run.execute(), events


def _times(events: list[Event], name: str) -> list[float]:
    return [e.time_s for e in events if isinstance(e, NodeEntered) and e.path.endswith(name)]


@pytest.mark.parametrize("answer_after_s", [0.0, 0.25])
def test_a_check_that_asks_a_service_belongs_to_its_tick(answer_after_s: float) -> None:
    """The answer takes time; the motion beside it is not stopped for that, in any of the ticks."""
    result, events = run_virtual(
        _run(_watching("{state: test.CheckHeld, with: {times: 2}}"), answer_after_s=answer_after_s)
    )
    assert result.outcome == "success"
    assert _times(events, "/move") == [2 * answer_after_s]
    assert len(_times(events, "/CheckHeld")) > 2
    assert not any(
        event.preempted for event in events if isinstance(event, NodeExited) and event.path.endswith("/move")
    )


def test_a_check_whose_service_takes_too_long_is_running() -> None:
    """After a second the tick goes on without it; a check that is RUNNING stops what follows it."""
    slow = "{state: test.CheckHeld}"
    result, events = run_virtual(_run(_watching(slow), answer_after_s=1.5, stop_at_s=6.0))
    assert result.status == "stopped"
    left = [event for event in events if isinstance(event, NodeExited) and event.path.endswith("/move")]
    assert (left[0].time_s, left[0].preempted) == (3.0, True)


async def test_it_does_on_a_real_clock_too() -> None:
    """Where the answer comes after many turns of the loop."""
    text = f"""{HEAD}
root:
  tree:
    sequence:
      memory: false
      children: [{{state: test.CheckHeld}}, {{state: test.Act, name: move, with: {{script: [[0.05, true]]}}}}]
"""
    plan = new_plan(parse_behavior(text, file="test.yaml"), {**CATALOGUE, "test.CheckHeld": CheckHeld})
    result, events = await _run(plan, answer_after_s=0.02)
    assert (result.outcome, len(_times(events, "/move"))) == ("success", 1)


def test_nothing_ticks_while_nothing_wakes() -> None:
    """The check would be asked at every tick: it is when the tree begins, and when the hour is over."""
    told = run_plan(
        tree_plan("""
        sequence:
          memory: false
          children: [{state: test.Check, name: tick}, {state: test.Act, with: {script: [[3600, true]]}}]
    """)
    )
    assert told.entered("tick") == [0, HOUR_S]


def test_what_goes_on_elsewhere_does_not_tick_the_tree() -> None:
    """Neither transitions of a machine beside it, nor those inside a leaf, nor writes that no guard reads."""
    text = f"""{HEAD}
userdata: {{value: 0}}
root:
  concurrency:
    states:
      beside: {{foreach: {{times: 50, child: {{state: test.Write, with: {{after_s: 0.1}}}}}}}}
      tree:
        tree:
          sequence:
            memory: false
            children:
              - {{state: test.Check, name: tick}}
              - guard: {{when: "${{value == 0}}", child: {{state: test.Check}}}}
              - machine:
                  initial: a
                  states:
                    a: {{state: test.Write, with: {{after_s: 1, value: 0}}, transitions: {{done: b}}}}
                    b: {{state: test.Write, with: {{after_s: 1, value: 0}}, transitions: {{done: done}}}}
    conditions: [{{success: {{tree: success, beside: exhausted}}}}, {{failure: {{tree: failure}}}}]
    otherwise: failure
"""
    told = run_plan(new_plan(parse_behavior(text, file="test.yaml"), CATALOGUE))
    assert (told.result.outcome, told.entered("tick")) == ("success", [0, 2])


@pytest.mark.virtual
async def test_a_tree_that_waits_uses_no_turn_of_the_loop() -> None:
    """A hundred leaves wait; one timer is all that is due."""
    leaves = ", ".join("{state: test.Act, with: {script: [[3600, true]]}}" for _ in range(100))
    run = asyncio.create_task(Run(tree_plan(f"parallel: [{leaves}]"), run="r", bus=SkillBus(new_clock())).execute())
    await asyncio.sleep(1.0)
    turns = 0
    while asyncio.get_running_loop().time() < HOUR_S - 1.0:
        turns += 1
        await asyncio.sleep(600.0)
    assert turns == 6
    assert (await run).duration_s == pytest.approx(HOUR_S)

"""Loops in which nothing is waited for: found in both clocks, whatever else goes on beside them, and named."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from textwrap import dedent

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.event import Event, NodeEntered
from engine.runtime.run import Run
from tests.engine.run_document import ObservedRun, plan_of, run_document

BESIDE = """
root:
  concurrency:
    states:
      loop:
        machine:
          initial: ping
          states:
            ping: PING
            pong: {state: test.Give, transitions: {a: ping, b: good, c: bad}}
      busy:
        machine:
          initial: nap
          states:
            nap: {state: test.Give, with: {after_s: 0.001}, transitions: {a: nap, b: nap, c: nap}}
    conditions: [{good: {loop: good}}, {bad: {loop: bad}}]
"""
GIVE = "{state: test.Give, transitions: {a: pong, b: bad, c: bad}}"
HARDLY = "{state: test.Give, with: {after_s: 1.0e-12}, transitions: {a: pong, b: bad, c: bad}}"


def run_in_real_time(text: str) -> ObservedRun:
    """Run a document with the clock on the wall."""
    plan = plan_of(dedent(text))
    events: list[Event] = []

    async def main() -> ObservedRun:
        run = Run(plan, run="r", bus=SkillBus(new_clock()))
        run.watch(events.append)
        return ObservedRun(await run.execute(), tuple(events))

    return asyncio.run(main())


@pytest.mark.parametrize("ping", [GIVE, HARDLY])
@pytest.mark.parametrize("run", [run_document, run_in_real_time])
def test_a_loop_that_waits_for_nothing_is_found_beside_one_that_waits(
    ping: str, run: Callable[[str], ObservedRun]
) -> None:
    told = run(BESIDE.replace("PING", ping))
    cause = str(told.result.cause)
    assert told.result.status == "errored"
    assert "10000 transitions in a row without waiting for anything, through" in cause
    assert "root/loop" in cause
    assert len([event for event in told.events if isinstance(event, NodeEntered)]) < 50_000


def test_a_loop_that_waits_inside_a_container_is_none() -> None:
    told = run_in_real_time(
        """
        userdata: {rounds: 0}
        root:
          machine:
            initial: inner
            states:
              inner:
                machine:
                  initial: nap
                  states:
                    nap: {state: test.Give, with: {after_s: 2.0e-6}, transitions: {a: count, b: count, c: count}}
                    count:
                      state: test.Write
                      with: {value: "${rounds + 1}"}
                      out: {value: rounds}
                      transitions: {done: over}
                guard: {when: "${rounds < 10500}", to: good}
                transitions: {over: inner}
        """
    )
    assert told.result.outcome == "good", told.result.cause


POLL = """
userdata: {ready: false, seen: 0}
root:
  concurrency:
    states:
      poll:
        machine:
          initial: nap
          states:
            nap: {state: test.Give, with: {after_s: 0.1}, transitions: {a: look, b: bad, c: bad}}
            look: {state: test.Give, with: {outcome: "${ready ? 'b' : 'a'}"}, transitions: {a: nap, b: good, c: bad}}
      other: OTHER
    conditions: [{good: {poll: good}}, {bad: {poll: bad}}, {good: {other: a}}]
"""


@pytest.mark.parametrize("other", ["{state: test.Give, with: {outcome: b}}", "{state: test.Give, with: {outcome: c}}"])
def test_a_loop_that_polls_in_virtual_time_for_what_cannot_change_any_more_is_named(other: str) -> None:
    told = run_document(POLL.replace("OTHER", other), polling_limit=2_000)
    cause = str(told.result.cause)
    assert told.result.status == "errored"
    assert "this loop has only waited for 100 s, and nothing can end it, through" in cause
    assert "root/poll" in cause


@pytest.mark.parametrize(
    "other",
    [
        "{state: test.Give, with: {outcome: a, after_s: 250}}",
        """{machine: {initial: one, states: {
            one: {state: test.Give, with: {outcome: a, after_s: 120}, transitions: {a: two, b: bad, c: bad}},
            two: {state: test.Give, with: {outcome: a, after_s: 120}, transitions: {a: a, b: bad, c: bad}}}}}""",
        "{state: test.Hang, timeout: {after: 250 s, to: a}}",
    ],
    ids=["sleeps", "sleeps twice", "timeout"],
)
def test_a_loop_that_polls_until_something_else_ends_is_none(other: str) -> None:
    told = run_document(POLL.replace("OTHER", other), polling_limit=2_000)
    assert told.result.outcome == "good", told.result.cause

"""What becomes of states that a crash found in mid-work, and starting from a chosen moment."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import dedent
from typing import ClassVar

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.errors import ControlError
from engine.event import Event, NodeEntered, NodeExited, RunResumed
from engine.runtime.history.resume import (
    ResumeDecisionRequired,
    last_entered_state,
    read_history,
    resume_checkpoint,
    start_checkpoint,
)
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from tests.engine.fake_states import CATALOGUE, Use
from tests.engine.run_document import HEAD, ObservedRun


class Ask(Use, frozen=True, kw_only=True):
    """Command a resource and ask after a crash."""

    state_name: ClassVar[str] = "test.Ask"
    resume: ClassVar[str] = "ask"


def _plan(text: str) -> Plan:
    return new_plan(parse_behavior(HEAD + dedent(text), file="test.yaml"), {**CATALOGUE, "test.Ask": Ask})


def _whole(plan: Plan) -> ObservedRun:
    async def main() -> ObservedRun:
        bus = SkillBus(new_clock())
        events: list[Event] = []
        async with bus:
            run = Run(plan, run="r1", bus=bus)
            run.watch(events.append)
            return ObservedRun(await run.execute(), tuple(events))

    return run_virtual(main())


def _events_until(told: ObservedRun, path: str) -> list[Event]:
    """Return the events up to the entry of a node."""
    at = next(i for i, event in enumerate(told.events) if isinstance(event, NodeEntered) and event.path == path)
    return list(told.events[: at + 1])


def _go_on(plan: Plan, events: list[Event], answers: Mapping[str, str], *, demanded: bool = False) -> ObservedRun:
    async def main() -> ObservedRun:
        bus = SkillBus(new_clock())
        new: list[Event] = []
        history = read_history(plan, "r1", events)
        checkpoint = resume_checkpoint(
            history, plan, answers=answers, demanded=demanded, last_seq=events[-1].seq, epoch=2
        )
        async with bus:
            run = Run(plan, run="r1", bus=bus, checkpoint=checkpoint)
            run.watch(new.append)
            return ObservedRun(await run.execute(), tuple(new))

    return run_virtual(main())


TWO = """
root:
  machine:
    initial: first
    states:
      first: {state: test.Use, with: {for_s: 2}, transitions: {done: second}}
      second: {state: %s, with: {for_s: 2}, %s transitions: {done: good}}
"""


def test_by_default_a_state_is_entered_again() -> None:
    plan = _plan(TWO % ("test.Use", ""))
    told = _go_on(plan, _events_until(_whole(plan), "root/second"), {})
    assert told.result.outcome == "good"
    assert isinstance(told.events[0], RunResumed)
    assert told.events[0].rerun == ("root/second",)
    assert told.lines == ["+root/second", "-root/second done", "-root good"]
    assert next(e.visit for e in told.events if isinstance(e, NodeEntered)) == 2


def test_hardware_asks_when_an_operator_is_demanded() -> None:
    plan = _plan(TWO % ("test.Use", ""))
    events = _events_until(_whole(plan), "root/second")
    with pytest.raises(ResumeDecisionRequired) as refusal:
        _go_on(plan, events, {}, demanded=True)
    assert [question.path for question in refusal.value.questions] == ["root/second"]
    assert "root/second (rerun, done)" in str(refusal.value)
    assert _go_on(plan, events, {"root/second": "rerun"}, demanded=True).result.outcome == "good"


@pytest.mark.parametrize(("state", "key"), [("test.Use", "resume: done,"), ("test.Ask", "")])
def test_an_outcome_is_taken_and_the_state_not_entered_again(state: str, key: str) -> None:
    plan = _plan(TWO % (state, key))
    told = _go_on(plan, _events_until(_whole(plan), "root/second"), {"root/second": "done"} if not key else {})
    assert told.result.outcome == "good"
    assert told.lines == ["-root/second done", "-root good"]
    assert next(e.cause.kind for e in told.events if isinstance(e, NodeExited) and e.cause) == "Resumed"


def test_answers_that_fit_nothing_are_refused() -> None:
    plan = _plan(TWO % ("test.Ask", ""))
    events = _events_until(_whole(plan), "root/second")
    for answers, reason in (
        ({"root/first": "rerun"}, "root/first: this state was not interrupted"),
        ({"root/second": "dnoe"}, "root/second: there is no outcome 'dnoe'"),
    ):
        with pytest.raises(ControlError) as refusal:
            _go_on(plan, events, answers)
        assert str(refusal.value).startswith(reason)
    with pytest.raises(ControlError, match="this run is over"):
        _go_on(plan, list(_whole(plan).events), {})


def test_the_data_of_a_moment_start_a_new_run_at_a_chosen_step() -> None:
    text = """
    userdata: {value: 0}
    root:
      machine:
        initial: one
        states:
          one: {state: test.Write, with: {value: 1, after_s: 1}, transitions: {done: two}}
          two: {state: test.Write, with: {value: "${value + 10}", after_s: 1}, transitions: {done: three}}
          three: {state: test.Write, with: {value: "${value * 2}", after_s: 1}, transitions: {done: good}}
    """
    plan = _plan(text)
    whole = _whole(plan)
    events = _events_until(whole, "root/two")
    assert last_entered_state(events, events[-1].seq) == "root/two"
    history = read_history(plan, "r1", whole.events, until_seq=events[-1].seq)

    async def main(path: str) -> ObservedRun:
        bus = SkillBus(new_clock())
        new: list[Event] = []
        async with bus:
            run = Run(plan, run="r2", bus=bus, checkpoint=start_checkpoint(history, plan, path))
            run.watch(new.append)
            return ObservedRun(await run.execute(), tuple(new))

    again = run_virtual(main("root/two"))
    assert (again.result.outcome, again.result.userdata) == ("good", {"value": 22})
    assert again.lines[:2] == ["+root", "+root/two"]
    assert again.events[0].seq == 1
    skipped = run_virtual(main("root/three"))
    assert skipped.result.userdata == {"value": 2}
    with pytest.raises(ControlError, match="there is no such node"):
        run_virtual(main("root/four"))


def test_a_run_that_starts_inside_a_branch_gives_its_container_the_whole_timeout() -> None:
    """The run of old had spent two of its seconds there; the branch beside it goes on as it stood."""
    plan = _plan("""
    root:
      timeout: {after: 3 s, to: bad}
      concurrency:
        states:
          one: {state: test.Give, with: {after_s: 2}}
          two: {state: test.Give, with: {after_s: 2.5}}
        conditions: [{good: {one: a, two: a}}]
    """)
    whole = _whole(plan)
    history = read_history(plan, "r1", whole.events, until_seq=_events_until(whole, "root/two")[-1].seq + 1)
    assert history.state.time_s == 2.0
    points = start_checkpoint(history, plan, "root/two").points
    assert (points["root"].elapsed_s, points["root/one"].left) == (0.0, "a")

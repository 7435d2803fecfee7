"""The engine dies at any event of a run whose behavior was changed: another goes on in the version that counts then."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from textwrap import dedent

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import BehaviorChanged, Event, NodeEntered, RunEnded
from engine.journal import MemoryRunJournal
from engine.runtime.history.resume import read_history, resume_checkpoint
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import HEAD
from tests.engine.runtime.control.operate import operate, pause, resume

OLD = """
userdata: {gone: "", left: ""}
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            gone: {state: test.Write, with: {value: here}, out: {value: gone}}
            given_up: {state: test.Hang}
            left:
              machine:
                initial: one
                states:
                  one: {state: test.Give, with: {after_s: 4}, transitions: {a: two, b: two, c: two}}
                  two: {state: test.Write, with: {value: old}, out: {value: left}, transitions: {done: out}}
          conditions: [{fine: {left: out, gone: done}}]
        transitions: {fine: good}
"""
NEW = """
userdata: {gone: "", left: ""}
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left:
              machine:
                initial: one
                states:
                  one: {state: flow.Wait, with: {duration_s: 3}, transitions: {done: two}}
                  two: {state: test.Write, with: {value: new}, out: {value: left}, transitions: {done: out}}
            fresh: {state: test.Give, with: {after_s: 2}}
          conditions: [{fine: {left: out, fresh: a}}]
        transitions: {fine: good}
"""


def _plan(text: str) -> Plan:
    return new_plan(parse_behavior(HEAD + dedent(text), file="test.yaml"), WITH_FLOW)


def _change(run: Run) -> None:
    run.change(_plan(NEW), preempt=True)


def _go_on(events: Sequence[Event], *, new: bool) -> tuple[RunResult, Sequence[Event]]:
    plan = _plan(NEW if new else OLD)

    async def main() -> tuple[RunResult, Sequence[Event]]:
        checkpoint = resume_checkpoint(read_history(plan, "r1", events), plan, answers={}, last_seq=events[-1].seq)
        journal = MemoryRunJournal(run_id="r1", kept=list(events))
        async with SkillBus(new_clock()) as bus:
            run = Run(plan, run="r1", bus=bus, journal=journal, checkpoint=checkpoint)
            asyncio.get_running_loop().call_at(50.0, run.control.resume)
            return await run.execute(), journal.kept

    return run_virtual(main())


def test_after_any_event_the_run_goes_on_in_the_version_that_counts_then() -> None:
    whole = operate(OLD, {1.0: pause, 2.0: _change, 5.0: resume}, states=WITH_FLOW)
    assert (whole.result.outcome, whole.result.userdata) == ("good", {"gone": "here", "left": "new"})
    changed = next(place for place, event in enumerate(whole.events) if isinstance(event, BehaviorChanged))
    event = whole.events[changed]
    assert isinstance(event, BehaviorChanged)
    assert (event.restarted, event.removed) == (("root/both/left/one",), ("root/both/gone", "root/both/given_up"))
    for cut in range(2, len(whole.events)):
        new = cut > changed
        result, events = _go_on(whole.events[:cut], new=new)
        assert (result.status, result.outcome) == ("finished", "good"), cut
        assert result.userdata == {"gone": "here", "left": "new" if new else "old"}, cut
        entered = [each.path for each in events if isinstance(each, NodeEntered)]
        assert ("root/both/fresh" in entered) == new, cut
        assert isinstance(events[-1], RunEnded)

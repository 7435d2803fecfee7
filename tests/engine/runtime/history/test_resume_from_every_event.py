"""A run gone on with from each of its events ends as it did: nothing committed is lost or done twice."""

from __future__ import annotations

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.event import Event, NodeEntered, NodeExited, RunResumed
from engine.journal import decode_event, encode_event
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.plan import Plan
from engine.runtime.run import Run
from tests.engine.run_document import ObservedRun, plan_of

BEHAVIORS = {
    "machine with a counter": """
        userdata: {count: 0}
        root:
          machine:
            initial: count
            states:
              count: {state: test.Count, with: {up_to: 4}, transitions: {more: wait, full: good}}
              wait: {state: test.Give, with: {after_s: 1}, transitions: {a: count, b: count, c: bad}}
        """,
    "concurrency with writers": """
        userdata: {value: 0, other: 0}
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
                          one: {state: test.Write, with: {value: 1, after_s: 1}, transitions: {done: two}}
                          two: {state: test.Write, with: {value: 2, after_s: 1}, out: {value: other},
                                transitions: {done: out}}
                    right: {state: test.Write, with: {value: 3, after_s: 3}}
                  conditions: [{fine: {left: out, right: done}}]
                transitions: {fine: last}
              last: {state: test.Write, with: {value: "${value + other}"}, out: {value: other},
                     transitions: {done: good}}
        """,
    "conditions that preempt some branches": """
        userdata: {value: 0, other: 0}
        root:
          machine:
            initial: some
            states:
              some:
                concurrency:
                  states:
                    mover:
                      machine:
                        initial: write
                        states:
                          write: {state: test.Write, with: {value: 1}, transitions: {done: hang}}
                          hang: {state: test.Hang, with: {cleanup_s: 1}, transitions: {done: spoil}}
                          spoil: {state: test.Write, with: {value: 9}, transitions: {done: out}}
                    again: {state: test.Raise, retry: {times: 9, backoff: 8}, on_error: spoiled}
                    lost: {state: test.Give, with: {after_s: 1}}
                    late: {state: test.Give, with: {after_s: 2}}
                    light: {state: test.Write, with: {value: 2, after_s: 4}, out: {value: other}}
                  conditions:
                    - {preempt: [mover], when: {lost: a}}
                    - {preempt: [again, late, lost], when: {late: a, lost: a}}
                    - {fine: {lost: a, late: a, light: done}}
                    - {wrong: {mover: out, light: done}}
                    - {wrong: {again: spoiled}}
                  otherwise: wrong
                transitions: {fine: rest, wrong: bad}
              rest: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: bad, c: bad}}
        """,
    "disabled nodes": """
        userdata: {value: 0}
        root:
          machine:
            initial: first
            states:
              first: {state: no.Such, disabled: done, transitions: {done: both}}
              both:
                concurrency:
                  states:
                    off: {state: no.Such, disabled: done}
                    writing: {state: test.Write, with: {value: 1, after_s: 1}}
                  conditions: [{fine: {off: done, writing: done}}]
                transitions: {fine: each}
              each:
                foreach: {times: 2, child: {state: no.Such, disabled: done}}
                transitions: {exhausted: tree, broken: bad}
              tree:
                tree:
                  sequence:
                    - {state: no.Such, disabled: true}
                    - {state: test.Give, name: a, with: {after_s: 1}}
                    - {selector: [{state: no.Such, disabled: true}, {state: test.Give, name: b}]}
                transitions: {success: good, failure: bad}
        """,
    "all branches preempted or done": """
        userdata: {value: 0}
        root:
          concurrency:
            states:
              hanging: {state: test.Hang, with: {cleanup_s: 2}}
              writing: {state: test.Write, with: {value: 1, after_s: 1}}
              last: {state: test.Give, with: {after_s: 2}}
            conditions:
              - {preempt: [hanging], when: {writing: done}}
              - {bad: {hanging: done}}
            otherwise: good
        """,
    "retry, timeout, guard and foreach": """
        userdata: {sum: [], last: 0}
        root:
          machine:
            initial: tries
            states:
              tries:
                state: test.Give
                with: {outcome: c, after_s: 1}
                retry: {times: 2, backoff: 1, outcomes: [c]}
                transitions: {a: bad, b: bad, c: slow}
              slow:
                state: test.Give
                with: {after_s: 100}
                timeout: {after: 2 s, to: skipped}
                transitions: {a: bad, b: bad, c: bad}
              skipped:
                state: test.Give
                guard: {when: "${last > 0}", to: each}
                transitions: {a: bad, b: bad, c: bad}
              each:
                foreach:
                  items: "${[3, 4, 5]}"
                  index: number
                  collect: {last: sum}
                  child:
                    machine:
                      initial: write
                      states:
                        write: {state: test.Write, with: {value: "${item * 10}", after_s: 1}, out: {value: last},
                                transitions: {done: next}}
                        next: {state: test.Give, with: {after_s: 0.5}, transitions: {a: done, b: done, c: failed}}
                  next: [done]
                transitions: {exhausted: good, broken: bad}
        """,
}


async def _run(plan: Plan, checkpoint_of: list[Event] | None) -> ObservedRun:
    bus = SkillBus(new_clock())
    events: list[Event] = []
    async with bus:
        history = ResumableState(plan, run="r1").read(checkpoint_of) if checkpoint_of is not None else None
        run = Run(plan, run="r1", bus=bus, checkpoint=history.checkpoint() if history is not None else None)
        run.watch(events.append)
        result = await run.execute()
    return ObservedRun(result, tuple(events))


def _plain(events: list[Event]) -> list[Event]:
    return [decode_event(encode_event(event)) for event in events]


@pytest.mark.parametrize("name", BEHAVIORS)
def test_a_run_resumed_after_any_of_its_events_ends_the_same(name: str) -> None:
    plan = plan_of(BEHAVIORS[name])
    whole = run_virtual(_run(plan, None))
    assert whole.result.outcome == "good"
    for count in range(1, len(whole.events)):
        known = _plain(list(whole.events[:count]))
        rest = run_virtual(_run(plan, known))
        assert rest.result.outcome == "good", whole.events[count - 1]
        assert rest.result.userdata == whole.result.userdata, whole.events[count - 1]
        assert rest.events[0].seq == count + 1
        finished = [(e.path, e.visit) for e in known if isinstance(e, NodeExited) and not e.preempted]
        again = {(e.path, e.visit) for e in rest.events if isinstance(e, NodeEntered)}
        assert again.isdisjoint(finished)


@pytest.mark.parametrize("name", BEHAVIORS)
def test_many_crashes_in_a_row_change_nothing(name: str) -> None:
    """The first engines die before anything has ended; then each lives longer than the one before, until one ends."""
    plan = plan_of(BEHAVIORS[name])
    whole = run_virtual(_run(plan, None))
    known = _plain(list(whole.events[:1]))
    lives = [3] * 30 + list(range(3, len(whole.events)))
    for events in lives:
        rest = run_virtual(_run(plan, known))
        assert rest.result.outcome == "good"
        assert rest.result.userdata == whole.result.userdata
        if len(rest.events) <= events:
            break
        known += _plain(list(rest.events[:events]))
    else:
        pytest.fail(f"none of {len(lives)} engines has come to the end")
    assert sum(isinstance(event, RunResumed) for event in known) > 30


TRIES = {
    "by outcome": "{state: test.Give, with: {outcome: c, after_s: 1}, retry: {times: 2, outcomes: [c]}, "
    "transitions: {a: bad, b: bad, c: good}}",
    "by error": "{state: test.Raise, retry: {times: 2, backoff: 1}, on_error: good, transitions: {done: bad}}",
}


@pytest.mark.parametrize("name", TRIES)
def test_a_crash_between_an_end_and_its_retry_loses_no_attempt(name: str) -> None:
    plan = plan_of(f"root: {{machine: {{initial: tries, states: {{tries: {TRIES[name]}}}}}}}")
    whole = run_virtual(_run(plan, None))
    for count in range(1, len(whole.events)):
        known = _plain(list(whole.events[:count]))
        rest = run_virtual(_run(plan, known))
        told = (*known, *rest.events)
        ended = [e for e in told if isinstance(e, NodeExited) and e.path == "root/tries"]
        assert len(ended) == 3, whole.events[count - 1]
        assert rest.result.outcome == whole.result.outcome == "good"

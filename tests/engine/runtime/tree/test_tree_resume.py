"""A run gone on with from each of its events inside a tree ends as it did: nothing is lost or done twice."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.event import Event, NodeEntered, NodeExited
from engine.journal import decode_event, encode_event
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.plan import Plan
from engine.runtime.run import Run
from tests.engine.runtime.tree.run_tree import ObservedRun, tree_plan
from tests.engine.runtime.tree.scripted_states import COUNTS

TREES = {
    "a sequence of actions": """
        sequence:
          - {state: test.Act, name: a, with: {script: [[1, true]]}}
          - {state: test.Write, name: w, with: {value: 5, after_s: 1}}
          - guard: {when: "${value == 5}", child: {state: test.Act, name: b, with: {script: [[1, true]]}}}
    """,
    "rounds of a parallel": """
        repeat:
          times: 3
          child:
            sequence:
              - {state: test.Act, name: a, with: {script: [[1, true]]}}
              - parallel:
                  - {state: test.Act, name: b, with: {script: [[1, true]]}}
                  - sequence:
                      - {state: test.Count, name: w, success: [more, full], with: {up_to: 9}}
                      - {state: test.Act, name: c, with: {script: [[3, true]]}}
              - {state: test.Check, name: d}
    """,
    "attempts of a retry": """
        retry:
          times: 5
          backoff: 0.5
          child:
            sequence:
              - {state: test.Act, name: a, with: {script: [[1, true]]}}
              - {state: test.Act, name: b, with: {script: [[1, false], [1, false], [1, true]]}}
    """,
    "a timeout, alternatives and a one-shot": """
        sequence:
          - one_shot: {child: {state: test.Write, with: {value: 1}}}
          - selector:
              - timeout: {after: 2 s, child: {state: test.Act, name: slow, with: {script: [[9, true]]}}}
              - {state: test.Act, name: no, with: {script: [[1, false]]}}
              - {state: test.Act, name: yes, with: {script: [[1, true]]}}
    """,
    "machines and trees inside": """
        sequence:
          - machine:
              initial: one
              states:
                one: {state: test.Write, with: {value: 1, after_s: 1}, transitions: {done: two}}
                two: {state: test.Act, with: {script: [[1, true]]}, transitions: {yes: fine, no: wrong}}
          - tree: {repeat: {times: 2, child: {state: test.Act, with: {script: [[1, true]]}}}}
          - {state: test.Give, with: {outcome: c, after_s: 1}, retry: {times: 1, outcomes: [c], backoff: 1 s},
             success: [c]}
    """,
    "thresholds of a parallel": """
        sequence:
          - parallel:
              success_count: 2
              failure_count: 2
              children:
                - {state: test.Act, name: a, with: {script: [[1, false]]}}
                - {state: test.Act, name: b, with: {script: [[2, true]]}}
                - {state: test.Act, name: c, with: {script: [[3, true]]}}
                - {state: test.Act, name: d, with: {script: [[9, true]]}}
          - {state: test.Act, name: e, with: {script: [[1, true]]}}
    """,
    "branches": """
        sequence:
          - if_then_else:
              if: {state: test.Check, name: asked, with: {script: [[1, false]]}}
              then: {state: test.Act, name: never}
              else: {state: test.Act, name: a, with: {script: [[1, true]]}}
          - while_do_else:
              while: {state: test.Check, name: clear}
              do:
                sequence:
                  memory: false
                  children:
                    - {state: test.Check, name: clear}
                    - {state: test.Act, name: b, with: {script: [[2, true]]}}
              else: {state: test.Act, name: c}
    """,
    "a condition that takes time": """
        while_do_else:
          while: {state: test.Check, name: clear, with: {script: [[1, true]]}}
          do: {sequence: [{state: test.Act, name: a, with: {script: [[1, true]]}}, {state: test.Act, name: b}]}
    """,
    "an end that no tick comes to while the condition takes time": """
        while_do_else:
          while: {state: test.Check, name: clear, with: {script: [[0, true], [1, true]]}}
          do: {sequence: {memory: false, children: [{state: test.Act, name: a, with: {script: [[0.5, true]]}}]}}
    """,
    "such an end in a parallel that runs again what has ended": """
        while_do_else:
          while: {inverter: {child: {state: test.Check, name: clear, with: {script: [[0, false], [1, false]]}}}}
          do:
            parallel:
              policy: all
              synchronise: false
              children:
                - {state: test.Act, name: a, with: {script: [[0.5, true]]}}
    """,
    "such an end below two conditions with parts": """
        while_do_else:
          while: {repeat: {times: 2, child: {state: test.Check, name: clear, with: {script: [[0, true], [0.5, true]]}}}}
          do:
            sequence:
              - while_do_else:
                  while: {inverter: {child: {state: test.Check, name: clear, with: {script: [[0, false], [1, false]]}}}}
                  do: {sequence: {memory: false, children: [{state: test.Act, name: a, with: {script: [[0.5, true]]}}]}}
              - {state: test.Act, name: c}
    """,
    "post-conditions": """
        sequence:
          - state: test.Act
            name: a
            with: {script: [[1, true]]}
            post: {on_success: {value: "${value + 1}", count: "${value}"}, always: {count: "${count + value}"}}
          - parallel:
              policy: one
              children:
                - sequence: [{state: test.Act, name: b, with: {script: [[1, true]]}}]
                  post: {on_success: {value: "${value + 10}"}, always: {count: "${count + 100}"}}
                - {state: test.Act, name: c, with: {script: [[9, true]]}}
            post: {always: {count: "${count * 3}"}}
          - {state: test.Act, name: d, with: {script: [[1, true]]}}
        post: {on_success: {value: "${value + 10000}"}}
    """,
    "what is skipped": """
        inverter:
          child:
            selector:
              - {state: test.Act, name: never, guard: {when: "${value > 5}", to: skipped}}
              - sequence: [{state: test.Act, name: unasked}]
                guard: {when: "${value > 5}", to: skipped}
              - parallel:
                  success_count: 1
                  children:
                    - {state: test.Act, name: not_now, guard: {when: "${value > 5}", to: skipped}}
                    - sequence:
                        - {state: test.Write, name: w, with: {value: 3, after_s: 1}}
                        - {state: test.Act, name: a, with: {script: [[1, false]]}}
              - guard:
                  when: "${value > 5}"
                  to: skipped
                  child: {state: test.Act, name: b}
    """,
    "a check that watches": """
        sequence:
          memory: false
          children:
            - {state: test.Check, name: clear}
            - parallel:
                - {state: test.Act, name: a, with: {script: [[1, true]]}}
                - {state: test.Act, name: b, with: {script: [[2, true]]}}
    """,
}


def _run(plan: Plan, known: list[Event] | None) -> ObservedRun:
    events: list[Event] = []
    COUNTS.clear()
    for event in known or ():
        if isinstance(event, NodeExited) and not event.preempted:
            COUNTS[event.path] = event.visit

    async def main() -> ObservedRun:
        async with SkillBus(new_clock()) as bus:
            history = ResumableState(plan, run="r1").read(known) if known is not None else None
            run = Run(plan, run="r1", bus=bus, checkpoint=history.checkpoint() if history is not None else None)
            run.watch(events.append)
            return ObservedRun(await run.execute(), tuple(events))

    return run_virtual(main())


def _plain(events: list[Event]) -> list[Event]:
    return [decode_event(encode_event(event)) for event in events]


@pytest.mark.parametrize("name", TREES)
def test_a_run_resumed_after_any_of_its_events_ends_the_same(name: str) -> None:
    """Also where the engine died in the middle of a tick."""
    plan = tree_plan(TREES[name], head="userdata: {value: 0, count: 0}")
    whole = _run(plan, None)
    assert whole.result.outcome == "success"
    for count in range(1, len(whole.events)):
        known = _plain(list(whole.events[:count]))
        rest = _run(plan, known)
        assert rest.result.outcome == "success", whole.events[count - 1]
        assert rest.result.userdata == whole.result.userdata, whole.events[count - 1]
        finished = [(e.path, e.visit) for e in known if isinstance(e, NodeExited) and not e.preempted]
        again = {(e.path, e.visit) for e in rest.events if isinstance(e, NodeEntered)}
        assert again.isdisjoint(finished), whole.events[count - 1]


@pytest.mark.parametrize("name", TREES)
def test_actions_that_had_ended_are_not_done_again(name: str) -> None:
    """Each is entered as often as without the crash, once more where it was cut in mid-work."""
    plan = tree_plan(TREES[name], head="userdata: {value: 0, count: 0}")
    whole = _run(plan, None)
    for count in range(1, len(whole.events)):
        known = _plain(list(whole.events[:count]))
        rest = _run(plan, known)
        for leaf in plan.nodes.values():
            if leaf.work.kind != "state" or leaf.name == "clear" or leaf.retry is not None:
                continue
            ended = _ends((*known, *rest.events), leaf.path)
            due = _ends(whole.events, leaf.path)
            assert len(ended) == len(due), (leaf.path, whole.events[count - 1])


def _ends(events: Sequence[Event], path: str) -> list[NodeExited]:
    return [e for e in events if isinstance(e, NodeExited) and e.path == path and not e.preempted]


def test_what_is_halted_assigns_once_however_the_engine_dies() -> None:
    """From when it has begun on, through its clean-up."""
    plan = tree_plan(
        """
        parallel:
          policy: one
          children:
            - {state: test.Act, name: a, with: {script: [[1, true]]}}
            - state: test.Act
              name: b
              with: {script: [[9, true]], cleanup_s: 1}
              post: {on_halted: {value: "${value + 1}", count: "${count + value}"}}
        """,
        head="userdata: {value: 0, count: 0}",
    )
    whole = _run(plan, None)
    begun = next(n for n, e in enumerate(whole.events) if isinstance(e, NodeEntered) and e.path.endswith("/b"))
    assert whole.result.userdata == {"value": 1, "count": 1}
    for count in range(begun + 1, len(whole.events)):
        rest = _run(plan, _plain(list(whole.events[:count])))
        assert rest.result.userdata == whole.result.userdata, whole.events[count - 1]

"""Keys that the branches of a concurrency container share: one value for all of them at any time."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.event import NodeExited, UserdataWritten
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.userdata.userdata import Scope
from tests.engine.run_document import ObservedRun, plan_of, run_document

ADD = '{state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}, transitions: {done: done}}'
COUNT = f"""
    userdata: {{count: 0}}
    root:
      concurrency:
        shared: [SHARED]
        states:
          a: {{machine: {{initial: wait, states: {{
            wait: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: add}}}},
            add: {ADD}}}}}}}
          b: {{machine: {{initial: wait, states: {{
            wait: {{state: flow.Wait, with: {{duration_s: 2}}, transitions: {{done: add}}}},
            add: {ADD}}}}}}}
        conditions: [{{good: {{a: done, b: done}}}}]
"""


def _count(shared: str) -> ObservedRun:
    return run_document(COUNT.replace("SHARED", shared))


def test_a_branch_reads_what_another_has_written() -> None:
    told = _count("count")
    assert told.result.userdata == {"count": 2}
    writes = [(e.path, e.scope, e.value) for e in told.events if isinstance(e, UserdataWritten)]
    assert writes == [("root/a/add", "", 1), ("root/b/add", "", 2)]


def test_what_is_not_shared_stays_apart_until_the_end() -> None:
    told = _count("")
    assert told.result.userdata == {"count": 1}
    merged = [e.path for e in told.events if isinstance(e, UserdataWritten) and e.scope == ""]
    assert merged == ["root/a", "root/b"]


def test_a_shared_key_of_the_container_itself_ends_with_it() -> None:
    told = run_document("""
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  userdata: {note: none}
                  shared: [note]
                  states:
                    tell: {state: flow.SetValue, with: {value: hello}, out: {value: note}}
                    hear: {machine: {initial: wait, states: {
                      wait: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: log}},
                      log: {state: flow.Log, with: {message: "${note}"}, transitions: {done: done}}}}}
                  conditions: [{done: {tell: done, hear: done}}]
                transitions: {done: good}
    """)
    assert "!root/both/hear/log hello" in told.lines
    assert told.result.userdata == {}


def test_a_tree_in_one_branch_is_halted_by_what_another_writes() -> None:
    """The check in front of the running action is asked again when the shared key changes."""
    told = run_document("""
        userdata: {enough: false}
        root:
          concurrency:
            shared: [enough]
            states:
              work:
                tree:
                  sequence:
                    memory: false
                    children:
                      - {state: flow.Decide, with: {when: "${!enough}"}}
                      - {state: test.Hang, with: {cleanup_s: 0.5}}
              clock: {machine: {initial: wait, states: {
                wait: {state: flow.Wait, with: {duration_s: 3}, transitions: {done: set}},
                set: {state: flow.SetValue, with: {value: true}, out: {value: enough}, transitions: {done: done}}}}}
            conditions: [{good: {work: failure, clock: done}}]
            otherwise: bad
    """)
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(3.5))


def test_inner_containers_share_what_they_name_and_no_more() -> None:
    """The inner container shares both keys, the outer one `up` only: `side` reaches the outer branch and no further."""
    told = run_document("""
        userdata: {up: 0, side: 0}
        root:
          concurrency:
            shared: [up]
            states:
              outer:
                concurrency:
                  shared: [up, side]
                  states:
                    one: {machine: {initial: up, states: {
                      up: {state: flow.SetValue, with: {value: 1}, out: {value: up}, transitions: {done: side}},
                      side: {state: flow.SetValue, with: {value: 1}, out: {value: side}, transitions: {done: done}}}}}
                    two: {machine: {initial: wait, states: {
                      wait: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: log}},
                      log: {state: flow.Log, with: {message: "two ${up} ${side}"}, transitions: {done: done}}}}}
                  conditions: [{ended: {one: done, two: done}}]
              beside: {machine: {initial: wait, states: {
                wait: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: log}},
                log: {state: flow.Log, with: {message: "beside ${up} ${side}"}, transitions: {done: done}}}}}
            conditions: [{good: {outer: ended, beside: done}}]
    """)
    assert {"!root/outer/two/log two 1 1", "!root/beside/log beside 1 0"} <= set(told.lines)
    assert told.result.userdata == {"up": 1, "side": 1}


def test_lists_grow_together() -> None:
    told = run_document("""
        userdata: {found: []}
        root:
          concurrency:
            shared: [found]
            states:
              a: {foreach: {times: 2, collect: {item: found}, child: {state: flow.Wait, with: {duration_s: 1}}}}
              b: {foreach: {times: 2, collect: {item: found}, child: {state: flow.Wait, with: {duration_s: 1.5}}}}
            conditions: [{good: {a: exhausted, b: exhausted}}]
    """)
    assert told.result.userdata == {"found": [0, 0, 1, 1]}


def test_a_run_that_is_gone_on_with_has_what_was_shared() -> None:
    """At every event: what a state that has ended wrote is there for both branches."""
    plan = plan_of(COUNT.replace("SHARED", "count"))
    events = _count("count").events
    for number in range(3, len(events) - 1):
        history = ResumableState(plan, run="run").read(events[:number])
        ended = {e.path for e in events[:number] if isinstance(e, NodeExited)}
        written = [e.value for e in events[:number] if isinstance(e, UserdataWritten) and e.path in ended]
        assert history.checkpoint().userdata == {"count": written[-1] if written else 0}


KEYS = ("a", "b", "c", "d")


@given(
    around=st.sets(st.sampled_from(KEYS)),
    shared=st.sets(st.sampled_from(KEYS)),
    writes=st.lists(st.tuples(st.integers(0, 2), st.sampled_from(KEYS), st.integers())),
)
def test_shared_keys_have_one_value_and_others_one_for_each_branch(
    around: set[str], shared: set[str], writes: list[tuple[int, str, int]]
) -> None:
    outer = Scope("", dict.fromkeys(around))
    inner = Scope("root", {}, outer)
    branches = [Scope(f"root/{name}*", {}, inner, isolated=True, shared=frozenset(shared)) for name in range(3)]
    together: dict[str, int] = {}
    apart: list[dict[str, int]] = [{}, {}, {}]
    for number, key, value in writes:
        branches[number].write(key, value)
        (together if key in shared else apart[number])[key] = value
    for branch, own in zip(branches, apart, strict=True):
        seen = {key: branch.read(key, reader="root") for key in KEYS if branch.has(key)}
        assert seen == {**dict.fromkeys(around), **together, **own}
        assert branch.own_values() == own
    assert {key: outer.own_values()[key] for key in around} == {key: together.get(key) for key in around}

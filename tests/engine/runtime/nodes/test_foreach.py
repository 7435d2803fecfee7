"""The rounds of a foreach: as many as there are, each at the same cost, with what they collect."""

from __future__ import annotations

import gc
import tracemalloc

import pytest

from engine.event import NodeEntered, TransitionTaken, UserdataAppended, UserdataWritten
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.userdata_history import UserdataHistory
from engine.runtime.nodes.foreach import MAX_COLLECTED
from tests.engine.run_document import ObservedRun, plan_of, run_document

COLLECT = """
userdata: {said: [before]}
root:
  machine:
    initial: each
    states:
      each:
        foreach:
          ROUNDS
          index: number
          collect: {said_last: said}
          child: {state: test.Write, with: {value: "${number}"}, out: {value: said_last}}
          next: [done]
        transitions: {exhausted: good, broken: bad}
"""


def collecting(rounds: str) -> str:
    """A document that collects the number of each round."""
    return COLLECT.replace("ROUNDS", rounds).replace("index: number", "index: number\n          as: item")


def lists(text: str, told: ObservedRun) -> list[object]:
    """What the result, the history and the book of a run say that was collected."""
    history = ResumableState(plan_of(text), run="r").read(told.events)
    book = UserdataHistory(lambda: plan_of(text))
    book.read(told.events)
    return [told.result.userdata["said"], history.userdata()["said"], book.scopes[""].values["said"].value]


@pytest.mark.parametrize("rounds", ["times: 3", "items: [a, b, c]", "times: 3.0", "times: '${6 / 2}'"])
def test_what_is_collected_is_the_same_in_result_resume_and_userdata_history(rounds: str) -> None:
    text = collecting(rounds)
    assert lists(text, run_document(text)) == [["before", 0, 1, 2]] * 3


def test_an_event_holds_what_a_round_has_added_alone() -> None:
    told = run_document(collecting("times: 3"))
    assert [event.value for event in told.events if isinstance(event, UserdataAppended)] == [0, 1, 2]
    assert not [event for event in told.events if isinstance(event, UserdataWritten) and event.key == "said"]


def test_a_list_that_was_there_before_stays_as_it_was_in_what_has_seen_it() -> None:
    """The events before, and the plan, whose first values every run begins with."""
    text = collecting("times: 2")
    plan = plan_of(text)
    told = run_document(text)
    book = UserdataHistory(lambda: plan)
    seen: list[object] = []
    for event in told.events:
        book.read([event])
        seen.append(book.scopes[""].values["said"].value)
    assert plan.userdata["said"] == ["before"]
    assert [value for at, value in enumerate(seen) if at == 0 or value != seen[at - 1]] == [
        ["before"],
        ["before", 0],
        ["before", 0, 1],
    ]


def test_branches_collect_apart_until_they_are_merged() -> None:
    text = """
        userdata: {said: [before]}
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  states:
                    left: {foreach: {times: 2, index: n, collect: {last: said}, next: [done], child: CHILD}}
                    right: {foreach: {times: 3, index: n, collect: {last: said}, next: [done], child: CHILD}}
                  conditions: [{fine: {left: exhausted, right: exhausted}}]
                transitions: {fine: good}
    """.replace("CHILD", "{state: test.Write, with: {value: '${n}'}, out: {value: last}}")
    told = run_document(text)
    assert told.result.userdata["said"] == ["before", 0, 1, 2]
    left = [
        e for e in told.events if isinstance(e, UserdataWritten | UserdataAppended) and e.scope == "root/both/left*"
    ]
    assert [e.value for e in left if e.key == "said"] == [["before", 0], 1]


def test_appending_to_what_is_no_list_fails_and_names_it() -> None:
    told = run_document(collecting("times: 1").replace("[before]", "text"))
    assert told.result.cause is not None
    assert "cannot append to 'said', which is a str" in str(told.result.cause)


def test_rounds_hold_no_memory_but_their_events_and_what_they_collect() -> None:
    """None of the events is larger than the first."""
    rounds = 4_000
    text = collecting(f"times: {rounds}").replace("[before]", "[]")
    gc.collect()
    tracemalloc.start()
    told = run_document(text)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert told.result.userdata["said"] == list(range(rounds))
    per_round = [sum(isinstance(event, kind) for event in told.events) for kind in (NodeEntered, TransitionTaken)]
    assert per_round == [rounds + 2, rounds + 1]
    assert peak / rounds < 2_000


def test_a_billion_rounds_are_no_list() -> None:
    told = run_document(
        """
        root:
          machine:
            initial: each
            states:
              each:
                foreach: {times: 1e9, child: {state: test.Give, with: {outcome: b}}, next: [a]}
                transitions: {exhausted: good, broken: bad}
        """
    )
    [entered] = [event for event in told.events if isinstance(event, NodeEntered) and event.path == "root/each"]
    assert (entered.inputs, told.result.outcome) == ({"times": 1_000_000_000}, "bad")


def test_more_than_may_be_collected_is_refused_with_its_key() -> None:
    said = ", ".join(["0"] * MAX_COLLECTED)
    told = run_document(collecting("times: 1").replace("[before]", f"[{said}]"))
    assert told.result.cause is not None
    assert f"`collect` has more than {MAX_COLLECTED:,} values for 'said'" in str(told.result.cause)

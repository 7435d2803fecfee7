"""A parallel with thresholds ends when so many of its children have ended so, or when too few are left."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import DocumentError
from engine.event import NodeExited
from tests.engine.runtime.tree.run_tree import run_tree, tree_plan
from tests.tiers import examples

Ends = list[tuple[float, bool]]
"""When each child ends, and whether it succeeds."""


def _tree(ends: Ends, **thresholds: int) -> str:
    leaves = [
        {"state": "test.Act", "name": f"n{number}", "with": {"script": [[at_s, good]]}}
        for number, (at_s, good) in enumerate(ends)
    ]
    return json.dumps({"parallel": {**thresholds, "children": leaves}})


def _expected(ends: Ends, needed: int, bearable: int) -> tuple[str, float]:
    """Say how it ends and when: all that ends at one instant is counted together."""
    for at_s in sorted({end_s for end_s, _ in ends}):
        succeeded = sum(good and end_s <= at_s for end_s, good in ends)
        failed = sum(not good and end_s <= at_s for end_s, good in ends)
        if succeeded >= needed:
            return "success", at_s
        if failed >= bearable or len(ends) - failed < needed:
            return "failure", at_s
    raise AssertionError("all have ended")


@given(
    ends=st.lists(st.tuples(st.sampled_from([1.0, 2.0, 3.0]), st.booleans()), min_size=1, max_size=5), data=st.data()
)
@settings(max_examples=examples(50, nightly=200), deadline=None)
def test_it_ends_as_soon_as_its_end_is_certain(ends: Ends, data: st.DataObject) -> None:
    """Those that are still at work are stopped, those that have ended were run once."""
    needed = data.draw(st.integers(1, len(ends)))
    bearable = data.draw(st.integers(1, len(ends)))
    told = run_tree(_tree(ends, success_count=needed, failure_count=bearable))
    outcome, at_s = _expected(ends, needed, bearable)
    assert (told.result.outcome, told.result.duration_s) == (outcome, pytest.approx(at_s))
    left = {
        event.path: event.preempted for event in told.events if isinstance(event, NodeExited) and "/n" in event.path
    }
    assert left == {f"root/parallel/n{number}": end_s > at_s for number, (end_s, _) in enumerate(ends)}
    assert all(told.entered(f"n{number}") == [0.0] for number in range(len(ends)))


def test_without_one_of_them_all_must_succeed_and_one_may_fail() -> None:
    """As without thresholds."""
    ends: Ends = [(1.0, True), (2.0, False), (3.0, True)]
    assert run_tree(_tree(ends, failure_count=1)).result.duration_s == 2.0
    # Of three one has failed: three cannot succeed any more.
    assert run_tree(_tree(ends, failure_count=3)).result.duration_s == 2.0
    assert run_tree(_tree(ends, success_count=1)).result.outcome == "success"


def test_the_cause_counts() -> None:
    """And names the first that failed."""
    told = run_tree(_tree([(1.0, False), (1.0, False), (5.0, True)], success_count=2, failure_count=2))
    assert told.why[1:3] == ["2 of 3 failed, and 2 must succeed; the first", "n0 ended with no"]


def test_in_a_loop_it_counts_anew() -> None:
    """What had ended in the round before is forgotten."""
    inside = _tree([(1.0, True), (2.0, True), (9.0, True)], success_count=2)
    told = run_tree(f"repeat: {{times: 3, child: {inside}}}")
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(6.0))
    assert told.entered("n0") == [0.0, 2.0, 4.0]


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("success_count: 3", "there are only 2 children"),
        ("failure_count: 3", "there are only 2 children"),
        ("success_count: 1, policy: one", "`policy` cannot be combined with thresholds"),
        ("success_count: 1, synchronise: false", "`synchronise` cannot be combined with thresholds"),
        ("success_count: 0", "success_count"),
    ],
)
def test_what_cannot_be_counted_is_refused(more: str, message: str) -> None:
    """At its place in the document."""
    with pytest.raises(DocumentError, match=message):
        tree_plan(f"parallel: {{{more}, children: [{{state: test.Act, name: a}}, {{state: test.Act, name: b}}]}}")

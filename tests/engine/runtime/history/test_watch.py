"""Watches: what an expression is worth at a node, at any time of a run."""

from __future__ import annotations

import pytest

from engine.runtime.history import UserdataHistory, Watch, evaluate_watch
from tests.engine.run_document import plan_of, run_document

NESTED = """
parameters: {limit: {type: integer, default: 3}}
userdata: {count: 0}
root:
  machine:
    initial: set
    states:
      set: {state: test.Write, with: {value: 7}, out: {value: count}, transitions: {done: inner}}
      inner:
        machine:
          initial: own
          userdata: {local: [1, 2], count: 20}
          states:
            own: {state: test.Write, with: {value: [5]}, out: {value: local}, transitions: {done: ended}}
        transitions: {ended: good}
"""
COUNTED = Watch(expression="count")


def _after(kept: int | None = None) -> UserdataHistory:
    """The userdata after some events; after the last one by default."""
    told = run_document(NESTED)
    history = UserdataHistory(lambda: plan_of(NESTED))
    history.read(told.events[:kept])
    return history


@pytest.mark.parametrize(
    ("path", "expression", "value"),
    [
        ("root/set", "count + limit", 10),
        ("root/set", "${count > limit}", True),
        ("root/inner/own", "count", 20),
        ("root/inner", "size(local)", 1),
        ("root/inner/own", "local[0]", 5),
        ("root/set", "n ${count}", "n 7"),
    ],
)
def test_an_expression_is_evaluated_as_its_node_reads_it(path: str, expression: str, value: object) -> None:
    found = evaluate_watch(Watch(expression=expression, path=path), _after())
    assert (found.value, found.problem) == (value, "")


@pytest.mark.parametrize(
    ("expression", "problem"),
    [
        ("cout", "`cout` is not defined here; did you mean count?"),
        ("local", "`local` is not defined here"),
        ("count >", "count >"),
        ("count + 'a'", "count"),
        (" ", "no expression"),
    ],
)
def test_what_has_no_value_says_why(expression: str, problem: str) -> None:
    found = evaluate_watch(Watch(expression=expression, path="root/set"), _after())
    assert found.value is None
    assert problem in found.problem


def test_of_the_past_it_has_the_value_of_that_time() -> None:
    values = [evaluate_watch(COUNTED, _after(kept)).value for kept in range(1, len(run_document(NESTED).events) + 1)]
    assert values[0] == 0
    # Without a node the innermost active container counts, and what has ended gives way to what goes on.
    assert [value for n, value in enumerate(values) if n == 0 or value != values[n - 1]][:3] == [0, 7, 20]

"""A clean-up that fails is an error, whatever stands between it and what preempted it."""

from __future__ import annotations

import pytest

from tests.engine.run_document import run_document

AROUND = """
flexcell: 1
name: cleanup
outcomes: [good, late]
success: [good]
root:
  machine:
    initial: outer
    states:
      outer:
        timeout: {after: 1 s, to: late}
        BODY
"""
MESSY = "{state: test.Messy, transitions: {done: good}}"
BODIES = {
    "a state": "machine: {initial: s, states: {s: MESSY}}",
    "a timeout": "machine: {initial: s, states: {s: {state: test.Messy, transitions: {done: good}, "
    "timeout: {after: 50 s, to: good}}}}",
    "a concurrency": "concurrency: {states: {s: {state: test.Messy}}, conditions: [{good: {s: done}}]}",
    "a tree": "tree: {sequence: [{state: test.Messy}]}",
    "a loop": "foreach: {times: 2, child: {state: test.Messy}, next: [done]}",
    "a priority": "priority: {initial: s, states: {s: MESSY}}",
}
LEADS = {
    "a tree": "{success: good, failure: good}",
    "a loop": "{exhausted: good, broken: good}",
}


@pytest.mark.parametrize("between", BODIES)
def test_a_clean_up_that_fails_ends_the_run(between: str) -> None:
    body = BODIES[between].replace("MESSY", MESSY)
    leads = LEADS.get(between, "{good: good}")
    told = run_document(AROUND.replace("BODY", f"{body}\n        transitions: {leads}"))
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "test.Messy raised ZeroDivisionError: in the clean-up" in told.result.cause.message
    assert "fake_states.py" in told.result.cause.chain()[-1].where

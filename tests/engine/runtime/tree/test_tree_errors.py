"""Errors in trees: others are preempted at once, the chain is kept, loops without time are named."""

from __future__ import annotations

import pytest

from tests.engine.runtime.tree.run_tree import run_tree


def test_an_error_of_a_leaf_preempts_the_others_and_fails_the_tree() -> None:
    """The error travels on after the others have cleaned up."""
    told = run_tree("""
        parallel:
          - {state: test.Hang, with: {cleanup_s: 1}}
          - sequence: [{state: test.Act, with: {script: [[1, true]]}}, {state: test.Raise}]
    """)
    assert told.lines[-4:] == [
        "1 +parallel/sequence/Raise", "1 -parallel/sequence/Raise error",
        "2 !parallel/Hang cleaned up", "2 -parallel/Hang preempted",
    ]  # fmt: skip
    assert told.why == ["test.Raise raised ZeroDivisionError: division by zero", "division by zero"]
    assert told.statuses[-2:] == ["1 parallel/sequence invalid", "1 parallel invalid"]


def test_an_error_beats_what_the_tick_would_have_decided() -> None:
    """Both end at t=1; the failure of the first would have halted the second."""
    told = run_tree("""
        parallel:
          - {state: test.Act, with: {script: [[1, false]]}}
          - machine:
              initial: wait
              states:
                wait: {state: test.Act, with: {script: [[1, true]]}, transitions: {yes: bad, no: bad}}
                bad: {state: test.Raise, transitions: {done: x}}
    """)
    assert told.result.status == "errored"


def test_a_leaf_may_handle_its_own_errors() -> None:
    """`on_error`, `retry`, `timeout` and `guard` of a leaf lead to a status."""
    assert run_tree("{state: test.Raise, on_error: success}").result.outcome == "success"
    told = run_tree("{state: test.Raise, on_error: failure, retry: {times: 2}}")
    assert (told.result.outcome, told.entered("Raise")) == ("failure", [0, 0, 0])
    assert told.why[1] == "Raise was left for failure"
    told = run_tree("{state: test.Hang, timeout: {after: 2 s, to: failure}}")
    assert told.why[1:] == ["Hang was left for failure", "no outcome within 2 s"]
    told = run_tree("{state: test.Hang, guard: {when: '${part == 2}', to: success}}", head="userdata: {part: 1}")
    assert (told.result.outcome, told.lines) == ("success", ["0 ~Hang guard success"])


@pytest.mark.parametrize(
    "tree",
    [
        "repeat: {times: 1000000, child: {state: test.Check, name: spin}}",
        "repeat: {times: 1000000, child: {state: test.Act, name: spin}}",
        "retry: {times: 1000000, child: {state: test.Raise, name: spin}}",
        "sequence: {memory: false, children: [{state: test.Act, name: spin}, {state: test.Act}]}",
    ],
)
def test_a_loop_in_which_no_time_passes_is_an_error_that_names_it(tree: str) -> None:
    """It would spin for ever."""
    told = run_tree(tree, instant_limit=300)
    assert told.result.status == "errored"
    assert told.why[0].startswith("ticked 300 times in a row without waiting for anything, through ")
    assert "/spin" in told.why[0]


def test_a_loop_in_which_time_passes_may_go_on() -> None:
    """Though each round has instant parts."""
    script = "{script: [[0.001, true]]}"
    tree = f"repeat: {{times: 500, child: {{sequence: [{{state: test.Check}}, {{state: test.Act, with: {script}}}]}}}}"
    assert run_tree(tree, instant_limit=100).result.outcome == "success"

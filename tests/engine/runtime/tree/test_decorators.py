"""Decorators of trees in virtual time."""

from __future__ import annotations

import pytest

from tests.engine.runtime.tree.run_tree import run_tree


def _act(name: str, *script: tuple[float, bool]) -> str:
    said = ", ".join(f"[{duration}, {str(good).lower()}]" for duration, good in script)
    return f"{{state: test.Act, name: {name}, with: {{script: [{said}]}}}}"


def test_an_inverter_turns_success_into_failure() -> None:
    """The chain says that it was a success."""
    told = run_tree("inverter: {child: {state: test.Check}}")
    assert told.why[1:] == ["Check succeeded, which counts as FAILURE"]


def test_a_timeout_fails_after_the_clean_up_of_its_child() -> None:
    """Time is the run's, so 3 s pass at once in a test."""
    told = run_tree("timeout: {after: 3 s, child: {state: test.Act, with: {script: [[9, true]], cleanup_s: 1}}}")
    assert told.lines == ["0 +timeout/Act", "4 !timeout/Act clean", "4 -timeout/Act preempted"]
    assert told.why[1:] == ["did not end within 3 s"]


def test_what_ends_at_the_very_moment_of_a_timeout_has_ended_in_time() -> None:
    """The end of the child wins."""
    assert run_tree(f"timeout: {{after: 3 s, child: {_act('x', (3, True))}}}").result.outcome == "success"


def test_a_timeout_counts_from_when_its_child_can_begin() -> None:
    """What is stopped before it takes two seconds to clean up; they are not the child's."""
    told = run_tree(f"""
        selector:
          - timeout: {{after: 1 s, child: {{state: test.Act, name: a, with: {{script: [[9, true]], cleanup_s: 2}}}}}}
          - timeout: {{after: 1 s, child: {_act("b", (0.5, True))}}}
    """)
    assert told.lines[-2:] == ["3 +selector/timeout_2/b", "3.5 -selector/timeout_2/b yes"]
    assert told.result.outcome == "success"


def test_a_retry_waits_longer_each_time() -> None:
    """The first run, and up to three more after 1, 2 and 4 s."""
    told = run_tree(f"retry: {{times: 3, backoff: 1 s, child: {_act('grasp', (1, False))}}}")
    assert told.entered("grasp") == [0, 2, 5, 10]
    assert [line for line in told.lines if "*" in line] == ["1 *retry 2", "3 *retry 3", "6 *retry 4"]
    assert told.why[1:] == ["failed 4 times", "grasp ended with no"]


def test_a_retry_takes_errors_below_it_as_failed_attempts() -> None:
    """The rest of the subtree is stopped before it is tried again; the last error is an error of the tree."""
    told = run_tree(f"""
        retry:
          times: 1
          child:
            parallel: [{_act("hold", (9, True))}, {{sequence: [{_act("reach", (1, True))}, {{state: test.Raise}}]}}]
    """)
    assert told.lines == [
        "0 +retry/parallel/hold", "0 +retry/parallel/sequence/reach", "1 -retry/parallel/sequence/reach yes",
        "1 +retry/parallel/sequence/Raise", "1 -retry/parallel/sequence/Raise error", "1 *retry 2",
        "1 !retry/parallel/hold clean", "1 -retry/parallel/hold preempted",
        "1 +retry/parallel/hold", "1 +retry/parallel/sequence/reach", "2 -retry/parallel/sequence/reach yes",
        "2 +retry/parallel/sequence/Raise", "2 -retry/parallel/sequence/Raise error",
        "2 !retry/parallel/hold clean", "2 -retry/parallel/hold preempted",
    ]  # fmt: skip
    assert told.result.status == "errored"
    assert told.why[0] == "test.Raise raised ZeroDivisionError: division by zero"


def test_a_retry_may_leave_errors_alone() -> None:
    """With `errors: false` an error ends the tree at once."""
    told = run_tree("retry: {times: 5, errors: false, child: {state: test.Raise}}")
    assert (told.result.status, told.entered("Raise")) == ("errored", [0])


def test_a_repeat_runs_its_child_until_it_has_succeeded_so_often() -> None:
    """It fails with the first failure."""
    told = run_tree(f"repeat: {{times: 3, child: {_act('x', (1, True))}}}")
    assert (told.entered("x"), told.result.outcome) == ([0, 1, 2], "success")
    told = run_tree(f"repeat: {{times: 3, child: {_act('x', (1, True), (1, False))}}}")
    assert (told.entered("x"), told.result.outcome) == ([0, 1], "failure")


def test_one_shot_remembers_its_end_for_this_activation_of_the_tree() -> None:
    """The second round finds it done."""
    once = f"{{one_shot: {{child: {_act('home', (1, True))}}}}}"
    told = run_tree(f"repeat: {{times: 2, child: {{sequence: [{once}, {_act('x', (1, True))}]}}}}")
    assert (told.entered("home"), told.entered("x")) == ([0], [1, 2])


def test_a_cooldown_fails_until_its_time_has_passed_and_then_wakes_the_tree() -> None:
    """A selector without memory goes back to it at t=4, three seconds after it had ended."""
    told = run_tree(f"""
        selector:
          memory: false
          children:
            - cooldown: {{after: 3 s, child: {_act("look", (1, False), (1, True))}}}
            - {_act("wait", (9, True))}
    """)
    assert told.lines[:5] == [
        "0 +selector/cooldown/look", "1 -selector/cooldown/look no", "1 +selector/wait",
        "4 !selector/wait clean", "4 -selector/wait preempted",
    ]  # fmt: skip
    assert told.lines[5:] == ["4 +selector/cooldown/look", "5 -selector/cooldown/look yes"]


def test_a_cooldown_says_that_it_is_cooling_down() -> None:
    """It is tried again at once and refuses."""
    told = run_tree(f"retry: {{times: 1, child: {{cooldown: {{after: 3 s, child: {_act('x', (1, False))}}}}}}}")
    assert told.why[1:] == ["failed 2 times", "the cooldown of 3 s is active"]


def test_a_guard_keeps_its_child_from_beginning() -> None:
    """The chain shows the condition."""
    told = run_tree(f"guard: {{when: '${{part > 1}}', child: {_act('x', (1, True))}}}", head="userdata: {part: 1}")
    assert (told.lines, told.why[1:]) == ([], ["${part > 1} is false"])


def test_a_guard_stops_its_child_when_the_condition_is_gone() -> None:
    """A machine beside it writes the key while the tree waits for nothing else."""
    told = run_tree(
        f"""
        selector:
          - sequence:
              memory: false
              children:
                - guard:
                    when: '${{value == "go"}}'
                    child: {{machine: {{initial: early, states: {{
                      early: {{state: test.Write, with: {{value: stop, after_s: 2}}, transitions: {{done: late}}}},
                      late: {{state: test.Hang, transitions: {{never: x}}}}}}}}}}
          - {_act("safe", (1, True))}
        """,
        head="userdata: {value: go}",
    )
    assert told.lines[-5:-1] == [
        "2 !selector/sequence/guard/machine/late cleaned up",
        "2 -selector/sequence/guard/machine/late preempted",
        "2 -selector/sequence/guard/machine preempted",
        "2 +selector/safe",
    ]
    assert told.result.outcome == "success"


def test_a_guard_that_opens_wakes_the_tree() -> None:
    """The better alternative takes over as soon as its condition is written."""
    told = run_tree(
        f"""
        selector:
          memory: false
          children:
            - guard: {{when: '${{value == "go"}}', child: {_act("better", (1, True))}}}
            - machine: {{initial: early, states: {{
                early: {{state: test.Write, with: {{value: go, after_s: 2}}, transitions: {{done: late}}}},
                late: {{state: test.Hang, transitions: {{never: x}}}}}}}}
        """,
        head="userdata: {value: stay}",
    )
    assert told.lines[-2:] == ["2 +selector/guard/better", "3 -selector/guard/better yes"]


def test_a_guard_that_is_no_truth_value_is_an_error() -> None:
    """It names the value."""
    told = run_tree("guard: {when: '${part}', child: {state: test.Check}}", head="userdata: {part: 1}")
    assert told.result.status == "errored"
    assert "the guard evaluates to 1, which is not a boolean" in told.why[0]


def test_remap_shows_another_status() -> None:
    """Failing to find something may be fine."""
    told = run_tree("remap: {failure: success, child: {state: test.Check, with: {script: [[0, false]]}}}")
    assert told.result.outcome == "success"
    told = run_tree("remap: {success: failure, child: {state: test.Check}}")
    assert told.why[1:] == ["SUCCESS counts as FAILURE"]


@pytest.mark.parametrize(
    "tree", ["remap: {failure: running, every: 0.5,", "condition: {status: success, every: 500 ms,"]
)
def test_what_hides_the_end_of_its_child_asks_it_again_from_time_to_time(tree: str) -> None:
    """Nothing below would wake the tree: the check is asked every half second."""
    script = "[[0, false], [0, false], [0, false], [0, true]]"
    told = run_tree(f"{tree} child: {{state: test.Check, name: ready, with: {{script: {script}}}}}}}")
    assert (told.entered("ready"), told.result.outcome) == ([0, 0.5, 1, 1.5], "success")

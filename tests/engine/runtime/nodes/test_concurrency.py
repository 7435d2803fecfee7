"""Concurrency containers: conditions in order, preemption with clean-up, one instant seen whole."""

from __future__ import annotations

import pytest

from tests.engine.run_document import HEAD, run_document


def _two(left: str, right: str, conditions: str, more: str = "") -> str:
    return f"""
        root:
          concurrency:
            states:
              left: {left}
              right: {right}
            conditions: {conditions}
            {more}
    """


GIVE_A = "{state: test.Give, with: {outcome: a, after_s: 1.0}}"
GIVE_B_LATER = "{state: test.Give, with: {outcome: b, after_s: 2.0}}"
GIVE_C = "{state: test.Give, with: {outcome: c, after_s: 1.0}}"
BOTH = "[{good: {left: a, right: b}}, {bad: {left: c}}, {bad: {right: c}}]"


def test_all_of_an_entry_must_hold() -> None:
    """AND inside an entry: the container waits for both."""
    told = run_document(_two(GIVE_A, GIVE_B_LATER, BOTH, "otherwise: bad"))
    assert told.lines == [
        "+root", "+root/left", "+root/right", "-root/left a", "-root/right b", "-root good",
    ]  # fmt: skip
    assert told.result.duration_s == pytest.approx(2.0)


def test_the_first_entry_that_holds_preempts_the_others() -> None:
    """OR across entries: one failure is enough, and the sibling cleans up before the container leaves."""
    told = run_document(_two(GIVE_C, "{state: test.Hang, with: {cleanup_s: 3.0}}", BOTH, "otherwise: bad"))
    assert told.lines[3:] == ["-root/left c", "!root/right cleaned up", "-root/right preempted", "-root bad"]
    assert told.result.duration_s == pytest.approx(4.0)
    assert told.result.cause is not None
    assert "left ended with c" in [link.message for link in told.result.cause.chain()]


def test_as_many_as_an_entry_asks_for_end_the_others() -> None:
    """Two of three have succeeded at t=2; the third is preempted and cleans up."""
    told = run_document("""
        root:
          concurrency:
            states:
              one: {state: test.Give, with: {outcome: a, after_s: 2.0}}
              two: {state: test.Give, with: {outcome: a, after_s: 1.0}}
              three: {state: test.Hang, with: {cleanup_s: 3.0}}
            conditions: [{good: {one: a, two: a, three: a, at_least: 2}}]
            otherwise: bad
    """)
    assert told.lines[4:] == [
        "-root/two a", "-root/one a", "!root/three cleaned up", "-root/three preempted", "-root good",
    ]  # fmt: skip
    assert (told.result.duration_s, told.result.cause) == (pytest.approx(5.0), None)


def test_what_finishes_at_one_instant_is_decided_in_document_order() -> None:
    """Both end at t=1; the first entry wins though the other child was listed first."""
    conditions = "[{good: {right: b}}, {bad: {left: a}}]"
    told = run_document(_two(GIVE_A, "{state: test.Give, with: {outcome: b, after_s: 1.0}}", conditions))
    assert told.result.outcome == "good"
    told = run_document(
        _two(GIVE_A, "{state: test.Give, with: {outcome: b, after_s: 1.0}}", conditions), stop_at_s=None
    )
    assert "-root/right b" in told.lines


def test_an_inner_container_that_ends_at_the_same_instant_is_seen() -> None:
    """Containers decide from the inside out."""
    told = run_document("""
        root:
          concurrency:
            states:
              deep:
                concurrency:
                  states:
                    x: {state: test.Give, with: {outcome: a, after_s: 1.0}}
                    y: {state: test.Give, with: {outcome: b, after_s: 1.0}}
                  conditions: [{both: {x: a, y: b}}]
                  otherwise: neither
              flat: {state: test.Give, with: {outcome: a, after_s: 1.0}}
            conditions:
              - {good: {deep: both, flat: a}}
              - {bad: {flat: a}}
            otherwise: bad
    """)
    assert told.result.outcome == "good"


def test_an_uncovered_combination_is_an_error_that_names_it() -> None:
    """Never a silent wait."""
    told = run_document(_two(GIVE_A, GIVE_C, "[{good: {left: a, right: a}}]"))
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "all children have finished (left: a, right: c) and no condition matches" in told.result.cause.message


def test_otherwise_takes_what_no_condition_covers() -> None:
    """The declared way out, with the combination in the cause."""
    told = run_document(_two(GIVE_A, GIVE_C, "[{good: {left: a, right: a}}]", "otherwise: bad"))
    assert told.result.outcome == "bad"
    assert told.result.cause is not None
    assert "no condition matches (left: a, right: c)" in [link.message for link in told.result.cause.chain()]


def test_a_child_that_raises_preempts_its_siblings_and_fails_the_container() -> None:
    """The error travels on after the siblings have cleaned up."""
    told = run_document(
        _two("{state: test.Raise}", "{state: test.Hang, with: {cleanup_s: 1.0}}", "[{good: {left: done}}]")
    )
    assert told.lines[-3:] == ["!root/right cleaned up", "-root/right preempted", "-root error"]
    assert told.result.cause is not None
    assert "test.Raise raised ZeroDivisionError" in told.result.cause.message


def test_branches_write_apart_and_the_last_in_document_order_wins() -> None:
    """The right branch finishes first in time; the order of the document decides."""
    told = run_document(
        HEAD
        + """
userdata: {value: nothing}
root:
  concurrency:
    states:
      left: {state: test.Write, with: {value: from left, after_s: 2.0}}
      right: {state: test.Write, with: {value: from right, after_s: 1.0}}
    conditions: [{good: {left: done, right: done}}]
"""
    )
    assert told.result.userdata["value"] == "from right"


def test_a_finished_child_does_not_run_again() -> None:
    """Each child is entered once per activation of the container."""
    told = run_document(_two(GIVE_A, GIVE_B_LATER, BOTH, "otherwise: bad"))
    assert told.lines.count("+root/left") == 1


def test_a_stop_preempts_all_branches() -> None:
    """Every branch cleans up exactly once, however long it takes."""
    told = run_document(
        _two(
            "{state: test.Hang, with: {cleanup_s: 1.0}}",
            "{state: test.Hang, with: {cleanup_s: 3.0}}",
            "[{good: {left: never}}]",
            "otherwise: bad",
        ),
        stop_at_s=1.0,
    )
    assert told.lines[3:] == [
        "!root/left cleaned up",
        "-root/left preempted",
        "!root/right cleaned up",
        "-root/right preempted",
        "-root preempted",
    ]
    assert (told.result.status, told.result.duration_s) == ("stopped", pytest.approx(4.0))


def test_a_sibling_that_is_slow_to_clean_up_is_named() -> None:
    """After five seconds the log says who is waited for."""
    told = run_document(_two(GIVE_C, "{state: test.Hang, with: {cleanup_s: 7.0}}", BOTH, "otherwise: bad"))
    assert "!root/right asked to stop 5 s ago and still cleaning up" in told.lines
    assert told.result.outcome == "bad"


def test_two_branches_may_not_command_one_resource() -> None:
    """The refusal names who holds it."""
    told = run_document(_two("{state: test.Use}", "{state: test.Use}", "[{good: {left: done, right: done}}]"))
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "left is commanded by run r at root/left in another branch" in told.result.cause.message


def test_a_timeout_of_a_branch_is_an_outcome_for_the_conditions() -> None:
    """`timeout.to` names what the conditions see."""
    told = run_document(
        _two(
            GIVE_A,
            "{state: test.Hang, timeout: {after: 3 s, to: late}}",
            "[{bad: {left: a, right: late}}]",
            "otherwise: good",
        )
    )
    assert (told.result.outcome, told.result.duration_s) == ("bad", pytest.approx(3.0))


def test_a_sibling_whose_clean_up_fails_is_an_error_of_the_container() -> None:
    """The other child had decided the outcome; what went wrong while stopping is not lost."""
    told = run_document(_two(GIVE_C, "{state: test.Messy}", "[{good: {left: a}}, {bad: {left: c}}]", "otherwise: bad"))
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "test.Messy raised ZeroDivisionError: in the clean-up" in told.result.cause.message


def test_a_loop_through_a_container_in_which_no_time_passes_is_named() -> None:
    """Starting tasks is no waiting: the loop is endless all the same."""
    text = """
    root:
      machine:
        initial: both
        states:
          both:
            concurrency:
              states: {left: {state: test.Give}, right: {state: test.Give}}
              conditions: [{again: {left: a, right: a}}]
            transitions: {again: both}
    """
    told = run_document(text)
    assert told.result.status == "errored"
    assert "10000 transitions in a row without waiting for anything, through both" in str(told.result.cause)

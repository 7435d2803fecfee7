"""State machines follow outcomes, keep data in scope, and explain what went wrong."""

from __future__ import annotations

import pytest

from tests.engine.run_document import run_document

CHAIN = """
    root:
      machine:
        initial: one
        states:
          one: {state: test.Give, with: {outcome: a}, transitions: {a: two, b: bad, c: bad}}
          two: {state: test.Give, with: {outcome: b}, transitions: {a: bad, b: good, c: bad}}
"""


def test_outcomes_choose_the_next_state() -> None:
    """Entered and left in order, ended with the machine's outcome."""
    told = run_document(CHAIN)
    assert told.lines == ["+root", "+root/one", "-root/one a", "+root/two", "-root/two b", "-root good"]
    assert (told.result.outcome, told.result.success, told.result.cause) == ("good", True, None)


def test_events_are_numbered_without_gaps() -> None:
    """Every fact has its place."""
    told = run_document(CHAIN)
    assert [event.seq for event in told.events] == list(range(1, len(told.events) + 1))


def test_a_loop_counts_in_userdata() -> None:
    """Keys declared in the document survive and come out with the result."""
    told = run_document("""
        userdata: {count: 0}
        root:
          machine:
            initial: count
            states:
              count: {state: test.Count, with: {up_to: 4}, transitions: {more: count, full: good}}
    """)
    assert (told.result.outcome, dict(told.result.userdata)) == ("good", {"count": 4})


def test_keys_are_remapped_per_instance() -> None:
    """`in` and `out` connect a state's keys to others."""
    told = run_document("""
        userdata: {tries: 2}
        root:
          machine:
            initial: count
            states:
              count: {state: test.Count, in: {count: tries}, out: {count: tries}, transitions: {more: bad, full: good}}
    """)
    assert (told.result.outcome, told.result.userdata["tries"]) == ("good", 3)


def test_an_input_changed_in_place_does_not_reach_the_container() -> None:
    """Inputs are copies."""
    told = run_document("""
        userdata: {items: [1, 2]}
        root:
          machine:
            initial: m
            states:
              m: {state: test.Mutate, transitions: {done: good}}
    """)
    assert dict(told.result.userdata) == {"items": [1, 2]}


def test_an_undeclared_output_is_an_error_that_names_state_and_key() -> None:
    """SMACH drops such a write silently."""
    told = run_document("""
        root:
          machine:
            initial: w
            states:
              w: {state: test.Write, with: {key: vlaue}, transitions: {done: good}}
    """)
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "test.Write wrote 'vlaue', which it does not declare" in told.result.cause.message
    assert "did you mean value?" in told.result.cause.message
    assert told.result.cause.where.startswith("test.yaml:")


def test_a_missing_key_is_an_error_that_names_near_ones() -> None:
    """Reading what nobody wrote fails at once."""
    told = run_document("""
        userdata: {itms: [1]}
        root:
          machine:
            initial: m
            states:
              m: {state: test.Mutate, transitions: {done: good}}
    """)
    assert told.result.cause is not None
    assert "userdata key 'items' is read but not defined here (did you mean itms?)" in told.result.cause.message


def test_a_value_of_the_wrong_type_is_refused_at_the_reader() -> None:
    """The message names key, input and state."""
    told = run_document("""
        userdata: {count: many}
        root:
          machine:
            initial: c
            states:
              c: {state: test.Count, transitions: {more: good, full: good}}
    """)
    assert told.result.cause is not None
    assert "'count' does not fit input 'count' of test.Count: expected integer, got text" in told.result.cause.message


def test_an_exception_ends_the_run_with_its_cause_and_place() -> None:
    """The chain goes from the node in the document to the line that raised."""
    told = run_document("""
        root:
          machine:
            initial: r
            states:
              r: {state: test.Raise, transitions: {done: good}}
    """)
    cause = told.result.cause
    assert (told.result.status, cause is not None) == ("errored", True)
    assert cause is not None
    assert cause.because is not None
    assert cause.where.startswith("test.yaml:")
    assert "fake_states.py:" in cause.because.where
    assert told.lines[-2:] == ["-root/r error", "-root error"]


def test_on_error_leads_on_with_the_cause() -> None:
    """A failure that the behavior handles is an outcome."""
    told = run_document("""
        root:
          machine:
            initial: r
            states:
              r: {state: test.Raise, on_error: bad, transitions: {done: good}}
    """)
    assert (told.result.status, told.result.outcome) == ("finished", "bad")
    assert told.result.cause is not None
    assert "ZeroDivisionError" in str([link.kind for link in told.result.cause.chain()])


def test_on_error_of_a_container_catches_what_is_inside() -> None:
    """Errors climb until somebody handles them; the containers on the way are left."""
    told = run_document("""
        root:
          machine:
            initial: inner
            states:
              inner:
                machine:
                  initial: r
                  states:
                    r: {state: test.Raise, transitions: {done: fine}}
                on_error: rescue
                transitions: {fine: good}
              rescue: {state: test.Give, transitions: {a: bad, b: bad, c: bad}}
    """)
    assert told.lines == [
        "+root", "+root/inner", "+root/inner/r", "-root/inner/r error", "-root/inner error",
        "+root/rescue", "-root/rescue a", "-root bad",
    ]  # fmt: skip
    assert told.result.cause is not None
    assert "inner was left for rescue" in str([link.message for link in told.result.cause.chain()])


def test_retry_runs_again_after_errors_with_growing_waits() -> None:
    """Two more attempts with 1 s and 2 s between them, then the error goes on."""
    told = run_document("""
        root:
          machine:
            initial: r
            states:
              r: {state: test.Raise, retry: {times: 2, backoff: 1 s}, on_error: bad, transitions: {done: good}}
    """)
    assert told.lines.count("+root/r") == 3
    assert (told.result.outcome, told.result.duration_s) == ("bad", pytest.approx(3.0))


def test_retry_on_an_outcome_gives_up_with_that_outcome() -> None:
    """The last outcome decides when attempts are used up."""
    told = run_document("""
        root:
          machine:
            initial: g
            states:
              g:
                state: test.Give
                with: {outcome: c}
                retry: {times: 2, outcomes: [c]}
                transitions: {a: good, b: good, c: bad}
    """)
    assert (told.lines.count("+root/g"), told.result.outcome) == (3, "bad")


def test_a_timeout_preempts_and_leads_on() -> None:
    """The state cleans up, and the cause says how long was waited."""
    told = run_document("""
        root:
          machine:
            initial: h
            states:
              h: {state: test.Hang, timeout: {after: 500 ms, to: bad}, transitions: {never: good}}
    """)
    assert told.lines == ["+root", "+root/h", "!root/h cleaned up", "-root/h preempted", "-root bad"]
    assert told.result.cause is not None
    assert told.result.cause.chain()[-1].message == "no outcome within 0.5 s"
    assert told.result.duration_s == pytest.approx(0.5)


def test_a_failure_keeps_its_cause_through_a_recovery() -> None:
    """What went wrong is told though the last state before `bad` went well."""
    told = run_document("""
        root:
          machine:
            initial: try
            states:
              try: {state: test.Give, with: {outcome: c}, transitions: {a: good, b: good, c: tidy}}
              tidy: {state: test.Give, transitions: {a: bad, b: bad, c: bad}}
    """)
    assert told.result.cause is not None
    assert "try ended with c" in [link.message for link in told.result.cause.chain()]


def test_a_loop_in_which_nothing_waits_is_an_error_that_names_it() -> None:
    """No engine may hang on its own document."""
    told = run_document("""
        root:
          machine:
            initial: ping
            states:
              ping: {state: test.Give, transitions: {a: pong, b: bad, c: bad}}
              pong: {state: test.Give, transitions: {a: ping, b: good, c: bad}}
    """)
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "transitions in a row without waiting for anything, through ping → pong" in told.result.cause.message


def test_a_stop_before_the_start_is_honoured_before_anything_starts() -> None:
    """SMACH loses it."""
    told = run_document(CHAIN, stop_first=True)
    assert (told.result.status, told.lines) == ("stopped", [])


def test_a_stop_cleans_up_every_level_once() -> None:
    """All active states leave, innermost first, and the run says why it ended."""
    told = run_document(
        """
        root:
          machine:
            initial: outer
            states:
              outer:
                machine:
                  initial: h
                  states:
                    h: {state: test.Hang, with: {cleanup_s: 2.0}, transitions: {never: fine}}
                transitions: {fine: good}
    """,
        stop_at_s=1.0,
    )
    assert told.lines[3:] == [
        "!root/outer/h cleaned up",
        "-root/outer/h preempted",
        "-root/outer preempted",
        "-root preempted",
    ]
    assert (told.result.status, told.result.duration_s) == ("stopped", pytest.approx(3.0))


def test_parameters_reach_states_through_expressions() -> None:
    """`${…}` is typed and follows userdata."""
    told = run_document(
        """
        flexcell: 1
        name: p
        parameters: {limit: {type: integer, default: 3}}
        userdata: {count: 0}
        outcomes: [good]
        success: [good]
        root:
          machine:
            initial: count
            states:
              count: {state: test.Count, with: {up_to: "${limit + 2}"}, transitions: {more: count, full: good}}
    """,
        parameters={"limit": 4},
    )
    assert told.result.userdata["count"] == 6


ONE = """
    root:
      machine:
        initial: s
        states:
          s: {{state: {state}{more}, transitions: {{{outcome}: next}}}}
          next: {{state: test.Give, transitions: {{a: good, b: good, c: bad}}}}
"""


def test_a_stop_beats_a_state_that_takes_no_notice() -> None:
    """It swallows the cancel and returns an outcome; its successor never starts."""
    told = run_document(ONE.format(state="test.Stubborn", more="", outcome="done"), stop_at_s=1.0)
    assert (told.result.status, told.lines[-2:]) == ("stopped", ["-root/s preempted", "-root preempted"])


@pytest.mark.parametrize("more", [", retry: {times: 3}", ", on_error: next", ", timeout: {after: 9 s, to: next}"])
def test_a_stop_beats_the_handlers_of_a_clean_up_that_fails(more: str) -> None:
    """No retry, no on_error, no timeout leads on; the failure is in the log."""
    told = run_document(ONE.format(state="test.Messy", more=more, outcome="done"), stop_at_s=1.0)
    assert told.result.status == "stopped"
    assert told.lines.count("+root/s") == 1
    assert "+root/next" not in told.lines
    assert any("clean-up failed: " in line for line in told.lines)


@pytest.mark.parametrize(("timeout_s", "stop_s"), [(2.0, 1.0), (1.0, 2.0), (1.0, 1.0)])
def test_timeout_and_stop_together_never_cut_a_clean_up(timeout_s: float, stop_s: float) -> None:
    """Whichever comes first, the clean-up of three seconds runs to its end once."""
    more = f", with: {{cleanup_s: 3.0}}, timeout: {{after: {timeout_s}, to: next}}"
    told = run_document(ONE.format(state="test.Hang", more=more, outcome="never"), stop_at_s=stop_s)
    assert (told.result.status, told.lines.count("!root/s cleaned up")) == ("stopped", 1)
    assert told.result.duration_s == pytest.approx(min(timeout_s, stop_s) + 3.0)


def test_a_cancellation_from_elsewhere_is_an_error_and_no_stop() -> None:
    """Nobody asked the state to stop: the run says so, and on_error can handle it."""
    told = run_document(ONE.format(state="test.SelfCancelling", more="", outcome="done"))
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "without a stop request" in told.result.cause.message

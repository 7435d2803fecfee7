"""A failed run is told from the node where it began, with what to do about it."""

from __future__ import annotations

from collections.abc import Iterable

from editor_web.past.failure import RunFailure, failure_of
from editor_web.past.state_history import RunStateHistory
from engine.event import Event, NodeEntered
from tests.engine.run_document import run_document

DEEP = """
root:
  machine:
    initial: begin
    states:
      begin: {state: test.Give, with: {after_s: 1}, transitions: {a: inner, b: bad, c: bad}}
      inner:
        machine:
          initial: calm
          states:
            calm: {state: test.Give, with: {after_s: 1}, transitions: {a: broken, b: good, c: bad}}
            broken: {state: test.Raise, transitions: {done: good}}
        transitions: {good: good, bad: bad}
"""
BY_OUTCOME = """
root:
  machine:
    initial: begin
    states:
      begin: {state: test.Give, transitions: {a: check, b: bad, c: bad}}
      check: {state: test.Give, with: {outcome: c, after_s: 2}, transitions: {a: good, b: good, c: bad}}
"""
RETRIED = """
root:
  machine:
    initial: broken
    states:
      broken: {state: test.Raise, retry: {times: 2, backoff: 1, errors: true}, transitions: {done: good}}
"""


def history(events: Iterable[Event]) -> RunStateHistory:
    """The course of a run with these events."""
    found = RunStateHistory("r")
    for event in events:
        found.follow(event)
    return found


def failure(text: str) -> tuple[RunFailure, tuple[Event, ...]]:
    """How a behavior fails."""
    events = run_document(text).events
    found = failure_of(history(events))
    assert found is not None
    return found, events


def test_an_error_is_traced_to_the_node_that_raised_it() -> None:
    """The way down to it, the causes with the node's own error first, and the moment."""
    found, _ = failure(DEEP)
    assert (found.path, found.time_s, found.text) == ("root/inner/broken", 2.0, "division by zero")
    assert [step.path for step in found.steps] == ["root", "root/inner", "root/inner/broken"]
    assert found.links[0].kind == "ZeroDivisionError"
    assert found.around[-1].path == "root/inner/broken"


def test_an_outcome_that_means_failure_is_traced_to_the_node_that_had_it() -> None:
    """Without any error in it."""
    found, _ = failure(BY_OUTCOME)
    assert (found.path, found.time_s, found.text) == ("root/check", 2.0, "check ended with c")
    assert [step.text for step in found.steps] == ["ended with bad", "ended with c"]


def test_of_several_attempts_the_last_one_is_reported() -> None:
    """Though the earlier ones failed alike."""
    found, events = failure(RETRIED)
    assert found.path == "root/broken"
    assert found.time_s == 3.0
    assert found.seq > len(events) / 2
    # From its entry it can be tried again.
    entries = [event.seq for event in events if isinstance(event, NodeEntered) and event.path == found.path]
    assert found.entered_seq == entries[-1]


def test_what_an_error_of_ours_suggests_is_reported_apart() -> None:
    """Brackets inside the advice are a part of it."""
    events = run_document(
        """
        root:
          machine:
            initial: begin
            states:
              begin: {state: test.Give, with: {outcome: d}, transitions: {a: good, b: bad, c: bad}}
        """
    ).events
    found = failure_of(history(events))
    assert found is not None
    assert found.hint
    assert f"({found.hint})" not in found.text


def test_a_run_that_is_not_over_has_none() -> None:
    """However much of it has failed."""
    events = run_document(BY_OUTCOME).events
    assert failure_of(history(events[:-1])) is None
    assert failure_of(history(())) is None

"""Times that could never pass are refused where they are given, with the node."""

from __future__ import annotations

import math

import pytest

from engine.document.duration import LONGEST_S, seconds
from engine.errors import DocumentError
from tests.engine.runtime.control.operate import operate

WAIT = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, with: {after_s: TIME}, on_error: bad, transitions: {a: good, b: good, c: good}}
"""


@pytest.mark.parametrize("time_s", ["1e300", "1e10"])
def test_a_state_that_would_wait_for_ever_fails(time_s: str) -> None:
    told = operate(WAIT.replace("TIME", time_s), {})
    assert told.result.outcome == "bad"
    assert told.result.cause is not None
    assert f"cannot wait for {float(time_s):g} s" in str([each.message for each in told.result.cause.chain()])


def test_thirty_years_are_a_time() -> None:
    told = operate(WAIT.replace("TIME", "1e9"), {})
    assert (told.result.outcome, told.result.duration_s) == ("good", LONGEST_S)


@pytest.mark.parametrize("text", [1e10, math.nan, math.inf, -1.0, "99999999999 h"])
def test_a_duration_of_a_document_is_a_time(text: float | str) -> None:
    with pytest.raises(DocumentError, match="is not a duration"):
        seconds(text)


def test_a_backed_off_retry_waits_thirty_years_at_most() -> None:
    text = """
    root:
      machine:
        initial: one
        states:
          one:
            state: test.Raise
            retry: {times: 40, outcomes: [], errors: true, backoff: 0.001}
            on_error: bad
            transitions: {done: good}
    """
    told = operate(text, {})
    assert told.result.outcome == "bad"

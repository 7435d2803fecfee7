"""The same document with the same seed gives the same event log, byte for byte."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from engine.journal import encode_event_log
from tests.engine.run_document import run_document

durations = st.floats(min_value=0.0, max_value=5.0, allow_nan=False)


@given(left=durations, right=durations, timeout=st.floats(min_value=0.1, max_value=5.0), stop=st.none() | durations)
def test_twice_the_same_run_gives_the_same_bytes(left: float, right: float, timeout: float, stop: float | None) -> None:
    """Whatever the times of branches, timeout and stop are, and even when they coincide."""
    text = f"""
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  states:
                    left: {{state: test.Give, with: {{outcome: a, after_s: {left!r}}}}}
                    right: {{state: test.Give, with: {{outcome: c, after_s: {right!r}}}}}
                  conditions: [{{one: {{left: a}}}}, {{two: {{right: c}}}}]
                timeout: {{after: {timeout!r}, to: bad}}
                transitions: {{one: good, two: bad}}
    """
    first, second = run_document(text, stop_at_s=stop), run_document(text, stop_at_s=stop)
    assert encode_event_log(first.events) == encode_event_log(second.events)
    entered = [line for line in first.lines if line.startswith("+")]
    left_lines = [line for line in first.lines if line.startswith("-")]
    assert len(entered) == len(left_lines)

"""An error says through which nodes it came, each with its place in the document, innermost first."""

from __future__ import annotations

from tests.engine.run_document import run_document


def test_the_cause_of_an_error_lists_the_nodes_around_it_with_their_places() -> None:
    told = run_document(
        """
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  states:
                    left: {state: test.Raise}
                  conditions: [{good: {left: done}}]
                transitions: {good: good}
        """
    )
    cause = told.result.cause
    assert cause is not None
    assert cause.nodes == (
        "root/both/left at test.yaml:13:13",
        "root/both at test.yaml:10:7",
        "root at test.yaml:6:1",
    )
    assert cause.because is not None
    assert cause.because.kind == "ZeroDivisionError"
    assert "fake_states.py:" in cause.because.where

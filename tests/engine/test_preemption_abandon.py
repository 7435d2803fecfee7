"""A state that does not confirm its stop is named, and in the end the run goes on without it."""

from __future__ import annotations

import pytest

from engine.event import NodeAbandoned
from engine.runtime.run_options import RunOptions
from tests.engine.runtime.control.operate import operate

DEAF = "{state: test.Deaf}"


def test_a_stop_that_is_not_confirmed_ends_the_run_with_an_error_naming_the_state() -> None:
    told = operate(f"root: {DEAF}", {1.0: lambda run: run.stop("enough")}, supervision=RunOptions(abandon_after_s=10))
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "root did not stop within 10 s and was abandoned" in told.result.cause.message
    assert told.result.abandoned == ("root",)
    assert told.result.duration_s == pytest.approx(13.5)
    assert [e.path for e in told.events if isinstance(e, NodeAbandoned)] == ["root"]


def test_a_sibling_that_is_not_done_cleaning_up_is_an_error_of_its_container() -> None:
    text = f"""
    root:
      concurrency:
        states:
          deaf: {DEAF}
          quick: {{state: test.Give, with: {{after_s: 1}}}}
        conditions: [{{good: {{quick: a}}}}]
    """
    told = operate(text, {}, supervision=RunOptions(abandon_after_s=10))
    assert told.result.status == "errored"
    assert told.result.abandoned == ("root/deaf",)
    assert next(line for line in told.lines if line.startswith("!")) == (
        "!root/deaf asked to stop 5 s ago and still cleaning up"
    )

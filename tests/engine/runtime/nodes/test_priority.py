"""While a priority container is active, branches outside its path stand still."""

from __future__ import annotations

import pytest

from engine.event import NodeEntered, NodeExited
from tests.engine.run_document import run_document
from tests.engine.runtime.control.operate import operate

TEXT = """
root:
  concurrency:
    states:
      work: {state: test.Give, with: {after_s: 4}}
      alarm:
        machine:
          initial: quiet
          states:
            quiet: {state: test.Give, with: {after_s: 1}, transitions: {a: handle, b: handle, c: handle}}
            handle:
              priority:
                initial: one
                states:
                  one: {state: test.Give, with: {after_s: 10}, transitions: {a: over, b: over, c: over}}
              transitions: {over: after}
            after: {state: test.Give, with: {after_s: 1}, transitions: {a: out, b: out, c: out}}
    conditions: [{good: {work: a, alarm: out}}]
"""


def test_the_other_branch_stands_still_meanwhile() -> None:
    told = run_document(TEXT)
    assert told.result.outcome == "good"
    ends = {event.path: event.time_s for event in told.events if isinstance(event, NodeExited)}
    assert ends["root/work"] == pytest.approx(14.0)
    assert ends["root/alarm/after"] == pytest.approx(12.0)


def test_a_stop_inside_a_priority_lets_everything_clean_up() -> None:
    told = operate(TEXT, {5.0: lambda run: run.stop("enough")})
    assert told.result.status == "stopped"
    assert told.lines[-5:] == [
        "-root/work preempted",
        "-root/alarm/handle/one preempted",
        "-root/alarm/handle preempted",
        "-root/alarm preempted",
        "-root preempted",
    ]


def test_of_two_priorities_at_one_instant_the_first_in_the_document_goes_first() -> None:
    branch = """
      {name}:
        priority:
          initial: one
          states:
            one: {{state: test.Give, with: {{after_s: 3}}, transitions: {{a: out, b: out, c: out}}}}
"""
    text = "root:\n  concurrency:\n    states:" + branch.format(name="left") + branch.format(name="right")
    told = run_document(text + "    conditions: [{good: {left: out, right: out}}]\n")
    assert told.result.duration_s == pytest.approx(6.0)
    assert told.lines[:4] == ["+root", "+root/left", "+root/left/one", "-root/left/one a"]


def test_a_nested_priority_holds_the_branches_around_it_too() -> None:
    text = """
root:
  priority:
    initial: both
    states:
      both:
        concurrency:
          states:
            slow: {state: test.Give, with: {after_s: 2}}
            inner:
              priority:
                initial: one
                states:
                  one: {state: test.Give, with: {after_s: 5}, transitions: {a: out, b: out, c: out}}
          conditions: [{fine: {slow: a, inner: out}}]
        transitions: {fine: good}
"""
    assert run_document(text).result.duration_s == pytest.approx(7.0)


@pytest.mark.parametrize("timed", [("left", "right"), ("left",), ("right",)])
@pytest.mark.parametrize("retried", [False, True])
def test_priorities_with_timeouts_entered_at_one_instant_take_turns(timed: tuple[str, ...], retried: bool) -> None:
    """They held each other for ever; the time of the one that waits stands still."""
    branch = """
      {name}:
        machine:
          initial: first
          states:
            first:
              priority:
                initial: one
                states:
                  one: {{state: test.Give, with: {{after_s: 3}}, transitions: {{a: out, b: out, c: out}}}}
              {timeout}
              {retry}
              transitions: {{out: out}}
"""
    text = "root:\n  concurrency:\n    states:"
    for name in ("left", "right"):
        timeout = "timeout: {after: 4, to: late}" if name in timed else ""
        retry = "retry: {times: 2}" if retried else ""
        text += branch.format(name=name, timeout=timeout, retry=retry)
    told = run_document(text + "    conditions: [{good: {left: out, right: out}}]\n    otherwise: bad\n")
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(6.0))
    entered = [event.path for event in told.events if isinstance(event, NodeEntered) and event.path.endswith("/one")]
    assert entered == ["root/left/first/one", "root/right/first/one"]

"""Small behaviors of which engine and reference interpreter once told different stories."""

from __future__ import annotations

from textwrap import indent

import pytest

from engine.document import Behavior, parse_behavior
from engine.event import NodeEntered
from tests.engine.reference.activation import activation_lines, lines_of
from tests.engine.reference.engine_run import run_to_end
from tests.engine.reference.interpreter import Interpreter

HEAD = "flexcell: 1\nname: t\noutcomes: [x, y]\nroot:\n"
STATE = """
machine:
  initial: s
  states:
    s: {state: test.Act, with: {after_s: 2.0}, transitions: {a: x}}
timeout: {after: 2.0, to: y}
"""
BRANCH = """
concurrency:
  states:
    p: {state: test.Act, with: {after_s: 2.0}}
  conditions: [{x: {p: a}}]
timeout: {after: 2.0, to: y}
"""
LATER_TIMEOUT_INSIDE = """
machine:
  initial: s
  states:
    s: {state: test.Act, with: {after_s: 2.0}, timeout: {after: 3.0, to: y}, transitions: {a: x}}
timeout: {after: 2.0, to: y}
"""
SAME_TIMEOUT_INSIDE = """
machine:
  initial: s
  states:
    s: {state: test.Act, with: {after_s: 3.0}, timeout: {after: 2.0, to: x}}
timeout: {after: 2.0, to: y}
"""
GOES_ON = """
machine:
  initial: s
  states:
    s: {state: test.Act, with: {after_s: 2.0}, timeout: {after: 3.0, to: y}, transitions: {a: t}}
    t: {state: test.Act, with: {after_s: 1.0}, transitions: {a: x}}
timeout: {after: 2.0, to: y}
"""
TWO_BRANCHES = """
concurrency:
  states:
    p: {state: test.Act, timeout: {after: 5 s, to: y}}
    q: {state: test.Act}
  conditions: [{x: {p: a, q: a}}]
"""
SHARED = """
concurrency:
  shared: [n]
  states:
    p:
      machine:
        initial: s
        states:
          s: {state: test.Act, with: {after_s: 1.0, add: 1}, in: {seen: n}, out: {sum: n}, transitions: {a: t}}
          t: {state: test.Act, with: {after_s: 2.0, add: 1}, in: {seen: n}, out: {sum: n}, transitions: {a: x}}
    q:
      machine:
        initial: s
        states:
          s: {state: test.Act, with: {after_s: 2.0}, transitions: {a: t}}
          t: {state: test.Act, guard: {when: "${n == 1}", to: y}, with: {add: 5}, in: {seen: n}, out: {sum: m},
              transitions: {a: x}}
  conditions: [{x: {p: x, q: x}}]
  otherwise: y
"""
AT_ONE_INSTANT = """
concurrency:
  shared: [n]
  states:
    p:
      machine:
        initial: s
        states:
          s: {state: test.Act, with: {after_s: 1.0}, transitions: {a: t}}
          t: {state: test.Act, with: {add: 1}, in: {seen: n}, out: {sum: n}, transitions: {a: x}}
    q:
      machine:
        initial: s
        states:
          s: {state: test.Act, with: {after_s: 1.0}, transitions: {a: t}}
          t: {state: test.Act, with: {add: 1}, in: {seen: n}, out: {sum: m}, transitions: {a: x}}
  conditions: [{x: {p: x, q: x}}]
"""


def _behavior(root: str) -> Behavior:
    return parse_behavior(HEAD + indent(root, "  "), file="t.yaml")


@pytest.mark.parametrize(
    "root",
    [
        pytest.param(STATE, id="state"),
        pytest.param(BRANCH, id="branch"),
        pytest.param(LATER_TIMEOUT_INSIDE, id="state with a later timeout"),
        pytest.param(SAME_TIMEOUT_INSIDE, id="state with the same timeout"),
    ],
)
def test_what_ends_at_the_very_instant_of_its_timeout_has_ended(root: str) -> None:
    """Whatever it is; the outcome may not depend on how many turns of the loop the end takes to travel out."""
    behavior = _behavior(root)
    assert Interpreter(behavior).run(10.0)[1] == "x"
    assert run_to_end(behavior, 10.0).result.outcome == "x"


def test_a_machine_goes_on_at_the_very_instant_of_its_timeout() -> None:
    """The transition of the state that just ended is taken, and its successor preempted."""
    behavior = _behavior(GOES_ON)
    reference = Interpreter(behavior)
    reference.run(10.0)
    assert activation_lines(lines_of(run_to_end(behavior, 10.0).events)) == activation_lines(reference.log)


def test_branches_are_entered_in_document_order() -> None:
    """Also the one that has a timeout; the order decides who is given a resource that two branches want."""
    events = run_to_end(_behavior(TWO_BRANCHES), 10.0).events
    assert [event.path for event in events if isinstance(event, NodeEntered)] == ["root", "root/p", "root/q"]


@pytest.mark.parametrize(
    ("root", "userdata"),
    [
        pytest.param(SHARED, {"n": 2, "m": 6}, id="of another instant"),
        pytest.param(AT_ONE_INSTANT, {"n": 1, "m": 2}, id="of one instant, in document order"),
    ],
)
def test_branches_see_each_other_write_shared_keys_at_once(root: str, userdata: dict[str, object]) -> None:
    """While they run, and before they are merged: what one reads is what the other has just written."""
    head = HEAD.replace("root:", "userdata: {n: 0, m: 0}\nroot:")
    behavior = parse_behavior(head + indent(root, "  "), file="t.yaml")
    reference = Interpreter(behavior)
    status, outcome, found = reference.run(10.0)
    result = run_to_end(behavior, 10.0).result
    assert (status, outcome) == (result.status, result.outcome) == ("finished", "x")
    assert found == dict(result.userdata) == userdata

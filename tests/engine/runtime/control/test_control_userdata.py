"""A value of the userdata of a paused run is replaced: who reads it next, what is recorded, resumed and taken back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import ControlError, FlexcellError, UserdataError
from engine.event import NodeEntered, OperatorCommanded, UserdataWritten
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.run import Run
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import ObservedRun, plan_of
from tests.engine.runtime.control.operate import Act, operate, pause, resume

COUNT = """
userdata: {n: 1, names: [cup], m: 0, seen: none}
root:
  machine:
    initial: wait
    userdata: {local: a}
    states:
      wait: {state: flow.Wait, with: {duration_s: 2}, transitions: {done: use}}
      use: {state: flow.SetValue, with: {value: "${n + 1}"}, out: {value: m}, transitions: {done: also}}
      also: {state: flow.SetValue, with: {value: "${local}"}, out: {value: seen}, transitions: {done: good}}
"""
BRANCHES = """
userdata: {n: 1, left_side: 0}
root:
  concurrency:
    states:
      left:
        machine:
          initial: wait
          userdata: {side: 1}
          states:
            wait: {state: flow.Wait, with: {duration_s: 2}, transitions: {done: use}}
            use: {state: flow.SetValue, with: {value: "${side}"}, out: {value: left_side}, transitions: {done: good}}
      right: {state: flow.Wait, with: {duration_s: 3}}
    conditions: [{good: {left: good, right: done}}]
    otherwise: bad
"""
LOOP = """
userdata: {seen: []}
root:
  machine:
    initial: rounds
    states:
      rounds:
        foreach:
          items: [1, 2, 3]
          as: item
          userdata: {twice: 0}
          collect: {twice: seen}
          next: [next]
          child:
            machine:
              initial: wait
              states:
                wait: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: use}}
                use:
                  {state: flow.SetValue, with: {value: "${2 * item}"}, out: {value: twice}, transitions: {done: next}}
        transitions: {exhausted: good, broken: bad}
"""


def sets(scope: str, key: str, value: object) -> Callable[[Run], None]:
    """The operator replaces a value."""
    return lambda run: run.control.set_userdata(scope, key, value)


def runs(text: str, acts: Mapping[float, Act]) -> ObservedRun:
    """The run of a document while an operator acts."""
    return operate(text, acts, states=WITH_FLOW)


def test_who_reads_next_reads_the_new_value() -> None:
    ran = runs(COUNT, {1: pause, 1.5: sets("", "n", 40), 1.6: sets("root", "local", "b"), 1.7: resume})
    assert ran.result.userdata["m"] == 41
    assert ran.result.userdata["seen"] == "b"


def test_it_is_recorded_as_a_command_and_as_a_write_of_no_node() -> None:
    ran = runs(COUNT, {1: pause, 1.5: sets("", "n", 40), 1.7: resume})
    command, write = (each for each in ran.events if each.time_s == 1.5)
    assert isinstance(command, OperatorCommanded)
    assert (command.command, command.path, command.arguments) == ("set_userdata", "", {"key": "n", "value": 40})
    assert isinstance(write, UserdataWritten)
    assert (write.path, write.scope, write.key, write.value) == ("", "", "n", 40)


@pytest.mark.parametrize(
    ("acts", "words"),
    [
        ({1: sets("", "n", 2)}, "the run is not paused"),
        ({1: pause, 1.5: sets("", "k", 2)}, "there is no userdata key 'k'"),
        ({1: pause, 1.5: sets("", "local", 2)}, "there is no userdata key 'local'"),
        ({1: pause, 1.5: sets("root/use", "n", 2)}, "no userdata is active there"),
        ({1: pause, 1.5: sets("parameters", "n", 2)}, "no userdata is active there"),
        ({1: pause, 1.5: sets("", "n", float("nan"))}, "cannot hold the number nan"),
        ({1: pause, 1.5: sets("", "names", [b"x"])}, "a value of type bytes"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(acts: dict[float, Any], words: str) -> None:
    refused: list[FlexcellError] = []

    def attempt(act: Callable[[Run], object]) -> Callable[[Run], object]:
        def do(run: Run) -> None:
            try:
                act(run)
            except (ControlError, UserdataError) as error:
                refused.append(error)

        return do

    ran = runs(COUNT, {**{at_s: attempt(act) for at_s, act in acts.items()}, 1.9: resume})
    (error,) = refused
    assert words in str(error)
    assert error.hint
    assert ran.result.userdata["m"] == 2
    assert not [each for each in ran.events if isinstance(each, OperatorCommanded) and each.command == "set_userdata"]


def test_the_value_of_a_branch_is_set_where_it_is_held() -> None:
    ran = runs(BRANCHES, {1: pause, 1.5: sets("root/left", "side", [7]), 1.7: resume})
    assert ran.result.userdata["left_side"] == [7]


def test_a_round_of_a_loop_ends_with_its_scope() -> None:
    refused: list[str] = []

    def late(run: Run) -> None:
        with pytest.raises(UserdataError, match="no userdata is active there"):
            run.control.set_userdata("root/rounds#0", "item", 9)
        refused.append("root/rounds#0")

    ran = runs(LOOP, {1.5: pause, 1.6: late, 1.7: sets("root/rounds#1", "item", 20), 1.8: resume})
    assert refused == ["root/rounds#0"]
    assert ran.result.userdata["seen"] == [2, 40, 6]


def test_the_value_that_was_given_is_not_shared() -> None:
    """Who changes the list later does not change the run."""
    names = ["plate"]
    ran = runs(COUNT, {1: pause, 1.5: sets("", "names", names), 1.6: lambda _: names.append("x"), 1.7: resume})
    assert ran.result.userdata["names"] == ["plate"]


TREE = """
userdata: {open: true}
root:
  machine:
    initial: go
    states:
      go:
        tree:
          selector:
            memory: false
            children:
              - sequence:
                  memory: false
                  children:
                    - {state: flow.Decide, with: {when: "${open}"}}
                    - {state: flow.Wait, name: long, with: {duration_s: 60}}
              - {state: flow.Wait, name: other, with: {duration_s: 1}}
        transitions: {success: good, failure: bad}
"""


def test_a_check_of_a_tree_sees_it_when_the_pause_ends() -> None:
    ran = runs(TREE, {1: pause, 1.5: sets("", "open", False), 3: resume})
    assert [each.time_s for each in ran.events if isinstance(each, NodeEntered) and each.path.endswith("other")] == [
        3.0
    ]


VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**40), 2**40)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)


@given(VALUES)
def test_a_run_that_is_resumed_has_what_was_set(value: object) -> None:
    ran = runs(
        COUNT,
        {1: pause, 1.5: sets("", "n", value), 1.7: sets("root", "local", value), 1.8: lambda run: run.stop("enough")},
    )
    state = ResumableState(plan_of(COUNT), run="r1").read(each for each in ran.events if each.time_s < 1.8)
    assert state.userdata() == {"n": value, "names": ["cup"], "m": 0, "seen": "none"}
    assert state.userdata("root") == {"local": value}

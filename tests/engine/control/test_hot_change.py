"""A new version of the behavior takes over a paused run, or is refused with the reason."""

from __future__ import annotations

from textwrap import dedent

import pytest

from engine.document import parse_behavior
from engine.errors import ControlError
from engine.event import BehaviorChanged
from engine.plan import new_plan
from engine.run import Run
from tests.engine.control.operate import Act, operate
from tests.engine.fake_states import CATALOGUE
from tests.engine.run_document import HEAD, Told

OLD = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left: {state: test.Give, with: {after_s: 4}}
            right:
              machine:
                initial: one
                states:
                  one: {state: test.Give, with: {after_s: 3}, transitions: {a: two, b: two, c: two}}
                  two: {state: test.Give, with: {after_s: 1}, transitions: {a: out, b: out, c: out}}
          conditions: [{fine: {left: a, right: out}}]
        transitions: {fine: good}
"""


def _change(text: str, said: list[str]) -> Act:
    plan = new_plan(parse_behavior(HEAD + dedent(text), file="test.yaml"), CATALOGUE)

    def act(run: Run) -> None:
        try:
            said.extend(run.change(plan).changes)
        except ControlError as error:
            said.append(f"refused: {error}")

    return act


def _changed(text: str, *, paused: bool = True) -> tuple[Told, list[str]]:
    said: list[str] = []
    acts: dict[float, Act] = {1.0: lambda run: run.control.pause()} if paused else {}
    told = operate(OLD, {**acts, 2.0: _change(text, said), 5.0: lambda run: run.control.resume()})
    return told, said


def test_transitions_and_conditions_of_several_active_branches_are_new_at_once() -> None:
    new = OLD.replace("{a: two, b: two, c: two}", "{a: three, b: two, c: two}").replace(
        "                  two: {state",
        "                  three: {state: test.Give, with: {after_s: 7}, transitions: {a: out, b: out, c: out}}\n"
        "                  two: {state",
    )
    told, said = _changed(new)
    assert said == ["root/both/right/three is new", "root/both/right/one has other transitions"]
    assert told.result.outcome == "good"
    assert "+root/both/right/three" in told.story
    assert "+root/both/right/two" not in told.story
    assert told.result.duration_s == pytest.approx(4.0 + 3.0 + 7.0)
    assert len([e for e in told.events if isinstance(e, BehaviorChanged)]) == 1


def test_a_running_state_keeps_its_parameters_until_it_is_entered_again() -> None:
    told, said = _changed(OLD.replace("after_s: 3", "after_s: 9"))
    assert said == ["root/both/right/one has other parameters, from its next entry on"]
    assert told.result.duration_s == pytest.approx(8.0)


ONE = "one: {state: test.Give, with: {after_s: 3}, transitions: {a: two, b: two, c: two}}"
REFUSED = {
    "another class": (
        OLD.replace(ONE, "one: {state: test.Use, transitions: {done: two}}"),
        "root/both/right/one is active as test.Give, now it is test.Use",
    ),
    "gone": (
        OLD.replace("initial: one", "initial: uno").replace(ONE, ONE.replace("one:", "uno:")),
        "root/both/right/one is active and not in the new version",
    ),
    "another branch": (
        OLD.replace("            right:", "            third: {state: test.Hang}\n            right:"),
        "root/both is active and has other branches now",
    ),
    "another kind": (
        OLD.replace("{state: test.Give, with: {after_s: 4}}", "{foreach: {times: 2, child: {state: test.Give}}}"),
        "root/both/left is active and was a state, now it is a foreach",
    ),
    "a new parameter without default": (
        "parameters: {speed: {type: number}}\n" + OLD,
        "the new parameter speed has no default",
    ),
}


@pytest.mark.parametrize(("text", "reason"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_go_on_is_refused_and_the_old_run_continues(text: str, reason: str) -> None:
    told, said = _changed(text)
    assert len(said) == 1
    assert said[0].startswith("refused: ")
    assert reason in said[0]
    assert told.result.outcome == "good"
    assert not [e for e in told.events if isinstance(e, BehaviorChanged)]


def test_a_run_that_is_neither_paused_nor_locked_is_left_alone() -> None:
    said: list[str] = []
    told = operate(OLD, {2.0: _change(OLD.replace("after_s: 3", "after_s: 9"), said)})
    assert "neither paused nor locked" in said[0]
    assert told.result.duration_s == pytest.approx(4.0)

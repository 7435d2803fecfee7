"""A new version of the behavior takes over a paused run, or is refused with the reason."""

from __future__ import annotations

import asyncio
from textwrap import dedent
from typing import ClassVar

import pytest

from engine.document import parse_behavior
from engine.errors import ControlError
from engine.event import BehaviorChanged, NodeEntered
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.state import Context, Outcome
from tests.engine.fake_states import CATALOGUE, Give
from tests.engine.run_document import HEAD, ObservedRun
from tests.engine.runtime.control.operate import Act, operate

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


class Announce(Give, frozen=True, kw_only=True):
    """End as told, and say when it is preempted."""

    state_name: ClassVar[str] = "test.Announce"

    async def run(self, ctx: Context) -> Outcome:
        try:
            return await super().run(ctx)
        except asyncio.CancelledError:
            ctx.log("cleaned up")
            raise


STATES = {"test.Announce": Announce}


def _change(text: str, said: list[str], *, preempt: bool = False) -> Act:
    plan = new_plan(parse_behavior(HEAD + dedent(text), file="test.yaml"), {**CATALOGUE, **STATES})

    def act(run: Run) -> None:
        try:
            said.extend(run.change(plan, preempt=preempt).changes)
        except ControlError as error:
            said.append(f"refused: {error}")

    return act


def _changed(
    text: str, *, paused: bool = True, preempt: bool = False, at_s: float = 1.0
) -> tuple[ObservedRun, list[str]]:
    said: list[str] = []
    acts: dict[float, Act] = {at_s: lambda run: run.control.pause()} if paused else {}
    change = _change(text, said, preempt=preempt)
    told = operate(OLD, {**acts, at_s + 1.0: change, at_s + 4.0: lambda run: run.control.resume()}, states=STATES)
    return told, said


def test_transitions_and_conditions_of_several_active_branches_are_new_at_once() -> None:
    new = OLD.replace("{a: two, b: two, c: two}", "{a: three, b: two, c: two}").replace(
        "                  two: {state",
        "                  three: {state: test.Give, with: {after_s: 7}, transitions: {a: out, b: out, c: out}}\n"
        "                  two: {state",
    )
    told, said = _changed(new)
    assert said == ["root/both/right/three is added", "root/both/right/one has changed transitions"]
    assert told.result.outcome == "good"
    assert "+root/both/right/three" in told.lines
    assert "+root/both/right/two" not in told.lines
    assert told.result.duration_s == pytest.approx(4.0 + 3.0 + 7.0)
    assert len([e for e in told.events if isinstance(e, BehaviorChanged)]) == 1


def test_a_running_state_keeps_its_parameters_until_it_is_entered_again() -> None:
    told, said = _changed(OLD.replace("after_s: 3", "after_s: 9"))
    assert said == ["root/both/right/one has changed parameters, effective at its next entry"]
    assert told.result.duration_s == pytest.approx(8.0)


ONE = "one: {state: test.Give, with: {after_s: 3}, transitions: {a: two, b: two, c: two}}"
TWO = "two: {state: test.Give, with: {after_s: 1}, transitions: {a: out, b: out, c: out}}"


def test_a_node_is_disabled_while_the_run_goes_on() -> None:
    off = TWO.replace("{state", "{disabled: a, state")
    told, said = _changed(OLD.replace(TWO, off))
    assert said == ["root/both/right/two is disabled"]
    assert (told.result.outcome, "+root/both/right/two" in told.lines) == ("good", False)


REFUSED = {
    "disabled": (
        OLD.replace(ONE, ONE.replace("{state", "{disabled: a, state")),
        "root/both/right/one is active and disabled in the new version",
    ),
    "another class": (
        OLD.replace(ONE, "one: {state: test.Use, transitions: {done: two}}"),
        "root/both/right/one is active as test.Give and becomes test.Use",
    ),
    "gone": (
        OLD.replace("initial: one", "initial: uno").replace(ONE, ONE.replace("one:", "uno:")),
        "root/both/right/one is active and not in the new version",
    ),
    "another kind": (
        OLD.replace("{state: test.Give, with: {after_s: 4}}", "{foreach: {times: 2, child: {state: test.Give}}}"),
        "root/both/left is active and changes from a state to a foreach",
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


OTHER_CLASS = OLD.replace(ONE, ONE.replace("test.Give", "test.Announce"))
THIRD = OLD.replace(
    "            right:\n", "            third: {state: test.Give, with: {after_s: 6}}\n            right:\n"
).replace("right: out}", "right: out, third: a}")
PREEMPT = " (the run continues with the old version; `preempt` preempts what cannot continue in the new one)"


def test_with_the_consent_of_the_operator_a_running_state_of_another_class_is_preempted_and_entered_anew() -> None:
    refused, said = _changed(OTHER_CLASS)
    assert said == [f"refused: root/both/right/one is active as test.Give and becomes test.Announce{PREEMPT}"]
    assert refused.result.duration_s == pytest.approx(8.0)
    told, said = _changed(OTHER_CLASS, preempt=True)
    assert said == ["root/both/right/one becomes test.Announce", "root/both/right/one is preempted and entered anew"]
    assert told.lines.count("-root/both/right/one preempted") == 1
    assert told.lines.count("+root/both/right/one") == 2
    assert told.result.outcome == "good"
    assert told.result.duration_s == pytest.approx(5.0 + 3.0 + 1.0)
    (change,) = [event for event in told.events if isinstance(event, BehaviorChanged)]
    assert (change.preempt, change.restarted, change.replaced) == (True, ("root/both/right/one",), change.restarted)


def test_a_running_state_with_other_parameters_or_keys_is_entered_anew_only_where_that_is_said() -> None:
    text = OLD.replace("after_s: 3", "after_s: 9")
    told, said = _changed(text, preempt=True)
    assert said == ["root/both/right/one has changed parameters", "root/both/right/one is preempted and entered anew"]
    assert told.result.duration_s == pytest.approx(5.0 + 9.0 + 1.0)


def test_a_running_node_of_another_kind_is_entered_anew_as_what_it_is_now() -> None:
    rounds = "{foreach: {times: 2, child: {state: test.Give, with: {after_s: 1}}}}"
    text = OLD.replace("{state: test.Give, with: {after_s: 4}}", rounds).replace("left: a", "left: exhausted")
    told, said = _changed(text, preempt=True)
    assert said[-1] == "root/both/left is preempted and entered anew"
    assert told.lines.count("+root/both/left/child") == 2
    assert told.result.outcome == "good"


def test_what_only_waits_for_its_entry_may_become_anything_else() -> None:
    text = OLD.replace("two: {state: test.Give", "two: {state: test.Announce")
    told, said = _changed(text, at_s=3.0)
    assert said == ["root/both/right/two becomes test.Announce"]
    assert told.result.outcome == "good"


def test_a_new_branch_of_an_active_concurrency_container_enters_at_once() -> None:
    told, said = _changed(THIRD)
    assert said == ["root/both/third is added", "root/both has changed conditions"]
    (entered,) = [
        event.time_s for event in told.events if isinstance(event, NodeEntered) and event.path.endswith("third")
    ]
    assert entered == pytest.approx(5.0)
    assert told.result.outcome == "good"
    assert told.result.duration_s == pytest.approx(5.0 + 6.0)


def _without_third(at_s: float, *, preempt: bool) -> tuple[ObservedRun, list[str]]:
    said: list[str] = []
    third = THIRD.replace("after_s: 6", "after_s: 2").replace(
        "third: {state: test.Give", "third: {state: test.Announce"
    )
    acts: dict[float, Act] = {
        at_s: lambda run: run.control.pause(),
        at_s + 1.0: _change(OLD, said, preempt=preempt),
        at_s + 4.0: lambda run: run.control.resume(),
    }
    return operate(third, acts, states=STATES), said


def test_a_branch_that_has_ended_may_go_and_one_under_way_only_where_that_is_said() -> None:
    told, said = _without_third(2.5, preempt=False)
    assert said == ["root/both has changed conditions", "root/both/third is removed"]
    assert told.result.outcome == "good"
    told, said = _without_third(1.0, preempt=False)
    assert said == [f"refused: the branch root/both/third is active and not in the new version{PREEMPT}"]
    assert told.result.outcome == "good"
    told, said = _without_third(1.0, preempt=True)
    assert said == ["root/both has changed conditions", "root/both/third is removed"]
    assert [line for line in told.lines if "third" in line] == [
        "+root/both/third",
        "!root/both/third cleaned up",
        "-root/both/third preempted",
    ]
    assert told.result.outcome == "good"


def test_what_a_removed_branch_has_written_stays() -> None:
    said: list[str] = []
    third = "            third: {state: test.Write, with: {value: 7}}\n            right:\n"
    keys = "userdata: {value: 0}\n"
    acts: dict[float, Act] = {
        1.0: lambda run: run.control.pause(),
        2.0: _change(keys + OLD, said),
        5.0: lambda run: run.control.resume(),
    }
    told = operate(keys + OLD.replace("            right:\n", third), acts)
    assert said == ["root/both/third is removed"]
    assert told.result.userdata == {"value": 7}

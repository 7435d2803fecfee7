"""Conditions that preempt some branches, in the middle of what an operator does with the run."""

from __future__ import annotations

from textwrap import dedent

import pytest

from engine.document import parse_behavior
from engine.errors import ControlError
from engine.event import BranchesPreempted, NodeEntered, NodeExited
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from tests.engine.fake_states import CATALOGUE
from tests.engine.run_document import HEAD, ObservedRun
from tests.engine.runtime.control.operate import Act, operate, pause, resume

TEXT = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            mover: {state: test.Hang, with: {cleanup_s: 2}}
            camera: {state: test.Give, with: {after_s: 1}}
            light: {state: test.Give, with: {after_s: 6}}
          conditions:
            - {preempt: [mover], when: {camera: a}}
            - {fine: {light: a}}
            - {fine: {camera: b}}
            - {wrong: {mover: never}}
        transitions: {fine: good, wrong: bad}
"""
MOVER = "            mover: {state: test.Hang, with: {cleanup_s: 2}}\n"
CONDITION = "            - {preempt: [mover], when: {camera: a}}\n"


def _change(text: str, *, preempt: bool = False) -> Act:
    plan = new_plan(parse_behavior(HEAD + dedent(text), file="test.yaml"), CATALOGUE)
    return lambda run: run.change(plan, preempt=preempt)


def _force(path: str, outcome: str) -> Act:
    def act(run: Run) -> None:
        try:
            run.control.force(path, outcome)
        except ControlError:
            return

    return act


def _cleaned(told: ObservedRun) -> list[str]:
    return [line for line in told.lines if line.endswith("cleaned up")]


def _preempted(told: ObservedRun) -> list[tuple[float, str]]:
    return [(e.time_s, e.path) for e in told.events if isinstance(e, NodeExited) and e.preempted]


def _fired(told: ObservedRun) -> list[tuple[float, tuple[str, ...]]]:
    return [(e.time_s, e.branches) for e in told.events if isinstance(e, BranchesPreempted)]


def test_a_clean_up_for_a_condition_stands_still_in_a_pause_like_any_other() -> None:
    """One second of it has passed at t=2, the other one passes after t=5; the light goes on from there as well."""
    told = operate(TEXT, {2.0: pause, 5.0: resume})
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(9.0))
    assert _preempted(told) == [(pytest.approx(6.0), "root/both/mover")]


@pytest.mark.parametrize("at_s", [1.0, 1.5])
def test_a_branch_that_cleans_up_for_a_condition_is_forced_to_nothing_else(at_s: float) -> None:
    """The outcome that somebody wants for it meanwhile would decide otherwise."""
    told = operate(TEXT, {at_s: _force("root/both/mover", "never")})
    assert told.result.outcome == "good"
    assert (len(_cleaned(told)), _preempted(told)) == (1, [(pytest.approx(3.0), "root/both/mover")])


def test_a_condition_ends_for_good_what_cleans_up_for_an_order() -> None:
    """Somebody wants the mover to run again at t=0.5; at t=1 it is to end, and the one clean-up is for both."""
    told = operate(TEXT, {0.5: lambda run: run.control.repeat("root/both/mover")})
    assert told.result.outcome == "good"
    assert (len(_cleaned(told)), _preempted(told)) == (1, [(pytest.approx(2.5), "root/both/mover")])
    assert _fired(told) == [(1.0, ("mover",))]


def test_a_container_that_is_forced_waits_for_who_cleans_up_for_a_condition() -> None:
    told = operate(TEXT, {2.0: _force("root/both", "wrong")})
    assert (told.result.outcome, told.result.duration_s) == ("bad", pytest.approx(3.0))
    assert len(_cleaned(told)) == 1


def test_a_condition_of_a_new_version_that_holds_already_fires_at_once() -> None:
    """The camera has ended at t=1, the new version comes at t=3."""
    told = operate(TEXT.replace(CONDITION, ""), {2.0: pause, 3.0: _change(TEXT), 4.0: resume})
    assert (told.result.outcome, _fired(told)) == ("good", [(3.0, ("mover",))])


def test_a_condition_that_has_fired_does_not_end_a_branch_that_comes_later() -> None:
    """The branch of a new version runs, though it has the name that the condition names."""
    without = TEXT.replace(MOVER, "").replace("            - {wrong: {mover: never}}\n", "")
    other = TEXT.replace("test.Hang, with: {cleanup_s: 2}", "test.Give, with: {after_s: 1}")
    acts: dict[float, Act] = {
        3.5: pause,
        3.6: _change(without),
        3.7: _change(other.replace("{mover: never}", "{mover: a}")),
        3.8: resume,
    }
    told = operate(TEXT, acts)
    assert told.result.outcome == "bad"
    assert [e.time_s for e in told.events if isinstance(e, NodeEntered) and e.path.endswith("mover")] == [0.0, 3.8]


def test_a_branch_may_be_taken_away_while_it_cleans_up_for_a_condition() -> None:
    """Its one clean-up is waited for, and the container goes on."""
    without = TEXT.replace(MOVER, "").replace("            - {wrong: {mover: never}}\n", "")
    told = operate(TEXT, {1.5: pause, 2.0: _change(without, preempt=True), 2.5: resume})
    assert (told.result.outcome, len(_cleaned(told))) == ("good", 1)
    told = operate(
        TEXT.replace("cleanup_s: 2", "cleanup_s: 8"), {1.5: pause, 2.0: _change(without, preempt=True), 2.5: resume}
    )
    late = [line for line in told.lines if "still cleaning up" in line]
    assert (told.result.outcome, late) == ("good", ["!root/both/mover asked to stop 5 s ago and still cleaning up"])


def test_a_branch_that_waits_for_the_operator_is_preempted_there() -> None:
    """Its outcome is held by a lock, and nobody will ever let it pass."""
    told = operate(
        TEXT.replace("test.Hang, with: {cleanup_s: 2}", "test.Give, with: {after_s: 0.5}"),
        {0.2: lambda run: run.control.lock("root/both/mover")},
    )
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(6.0))


def test_what_a_priority_holds_is_preempted_and_cleans_up_when_it_may_go_on() -> None:
    """The camera ends inside the priority of the guard; that one leaves at t=3."""
    told = operate(
        """
        root:
          concurrency:
            states:
              mover: {state: test.Hang, with: {cleanup_s: 2}}
              camera: {state: test.Give, with: {after_s: 1}}
              guard:
                machine:
                  initial: wait
                  states:
                    wait: {state: test.Give, with: {after_s: 1}, transitions: {a: first, b: end, c: end}}
                    first:
                      priority:
                        initial: hold
                        states:
                          hold: {state: test.Give, with: {after_s: 2}, transitions: {a: left, b: left, c: left}}
                      transitions: {left: end}
            conditions: [{preempt: [mover], when: {camera: a}}, {bad: {mover: never}}]
            otherwise: good
        """,
        {},
    )
    assert (told.result.outcome, len(_cleaned(told))) == ("good", 1)
    assert _fired(told) == [(1.0, ("mover",))]

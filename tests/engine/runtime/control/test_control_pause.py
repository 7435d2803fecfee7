"""Pausing holds the work itself, wherever the run stands."""

from __future__ import annotations

import pytest

from engine.event import GateReached, GoalHeld, GoalResumed, PauseConfirmed
from engine.runtime.run import Run
from tests.engine.runtime.control.operate import operate, pause, resume
from tests.engine.runtime.control.turntable import Turntable

LONG = """
root:
  machine:
    initial: first
    states:
      first: {state: test.Give, with: {after_s: 2}, transitions: {a: second, b: second, c: bad}}
      second: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: good, c: bad}}
"""
TURN = """
root:
  machine:
    initial: turn
    states:
      turn: {state: test.TurnTable, with: {for_s: 4}, transitions: {turned: good, failed: bad}}
"""


def test_a_paused_wait_stands_still_and_goes_on() -> None:
    told = operate(LONG, {0.5: pause, 10.5: resume})
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(13.0))


def test_a_pause_lets_no_node_enter_or_leave() -> None:
    told = operate(LONG, {1.0: pause, 3.0: lambda run: run.control.step(), 20.0: resume})
    reached = [event for event in told.events if isinstance(event, GateReached)]
    assert [(event.path, event.point, event.reasons) for event in reached] == [("root/second", "before", ("pause",))]
    assert told.result.duration_s == pytest.approx(21.0)


def test_the_timeout_of_a_node_stands_still_too() -> None:
    text = """
    root:
      machine:
        initial: only
        states:
          only:
            state: test.Give
            with: {after_s: 2}
            timeout: {after: 3, to: bad}
            transitions: {a: good, b: good, c: bad}
    """
    assert operate(text, {1.0: pause, 50.0: resume}).result.outcome == "good"


def test_a_stop_beats_a_pause() -> None:
    told = operate(LONG, {0.5: pause, 1.0: lambda run: run.stop("enough")})
    assert (told.result.status, told.result.duration_s) == ("stopped", pytest.approx(1.0))
    assert told.lines[-2:] == ["-root/first preempted", "-root preempted"]


def test_a_goal_is_held_until_it_is_resumed_and_the_pause_confirmed_when_at_rest() -> None:
    views: list[tuple[bool, bool]] = []

    def look(run: Run) -> None:
        view = run.control.view()
        views.append((view.paused, view.confirmed))

    told = operate(TURN, {1.0: pause, 1.1: look, 1.5: look, 9.0: resume, 9.1: look}, prepare=Turntable)
    assert views == [(True, False), (True, True), (False, False)]
    assert told.result.outcome == "good"
    kinds = (GoalHeld, PauseConfirmed, GoalResumed)
    assert [(type(e), e.time_s) for e in told.events if isinstance(e, kinds)] == [
        (GoalHeld, 1.25),
        (PauseConfirmed, 1.25),
        (GoalResumed, 9.0),
    ]
    assert told.result.duration_s == pytest.approx(4.0 + 7.75, abs=0.2)


def test_a_goal_that_cannot_be_held_is_named_and_its_outcome_waits() -> None:
    told = operate(TURN, {1.0: pause, 9.0: resume}, prepare=lambda bus: Turntable(bus, holdable=False))
    confirmed = next(e for e in told.events if isinstance(e, PauseConfirmed))
    assert confirmed.cannot == ("root/turn#1.1: this skill cannot be held",)
    assert told.result.duration_s == pytest.approx(9.0)


def test_a_resume_while_it_still_brakes_lets_it_go_on() -> None:
    told = operate(TURN, {1.0: pause, 1.1: resume}, prepare=Turntable)
    assert told.result.outcome == "good"
    assert told.result.duration_s < 4.6

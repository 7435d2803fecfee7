"""What an operator does to a run is in its events, with who waited where and for what."""

from __future__ import annotations

import pytest

from engine.errors import ControlError
from engine.event import (
    Event,
    GatePassed,
    GateReached,
    MessageLogged,
    NodeEntered,
    OperatorCommanded,
    OutcomeRequested,
)
from engine.runtime.control import Breakpoint
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from tests.engine.runtime.control.operate import Act, operate, pause, resume

LINE = """
userdata: {n: 3}
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, with: {after_s: 2}, autonomy: {a: high}, transitions: {a: two, b: two, c: bad}}
      two: {state: test.Give, with: {after_s: 4}, transitions: {a: good, b: bad, c: bad}}
"""
BRANCHES = """
root:
  concurrency:
    states:
      left: {machine: {initial: one, states: {one: {state: test.Give, with: {after_s: 1}, transitions: {a: two, b: bad, c: bad}}, two: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: bad, c: bad}}}}}
      right: {machine: {initial: one, states: {one: {state: test.Give, with: {after_s: 1}, transitions: {a: two, b: bad, c: bad}}, two: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: bad, c: bad}}}}}
    conditions: [{good: {left: good, right: good}}]
    otherwise: bad
"""  # noqa: E501
AT_TWO = Breakpoint(path="root/two")


def gates(events: tuple[Event, ...]) -> list[tuple[float, str, str, str]]:
    """Return when which node came to which gate, and went on."""
    return [
        (event.time_s, "waits" if isinstance(event, GateReached) else "passes", event.point, event.path)
        for event in events
        if isinstance(event, GateReached | GatePassed)
    ]


def end(run: Run) -> None:
    """Enough is seen."""
    run.stop("enough")


def test_every_command_is_recorded_with_what_it_says() -> None:
    acts: dict[float, Act] = {
        0.1: pause,
        0.2: lambda run: run.control.step("over"),
        0.3: resume,
        0.4: lambda run: run.control.lock("root/two", "look first"),
        0.5: lambda run: run.control.unlock("root/two"),
        0.6: lambda run: run.control.set_autonomy("low"),
        0.7: lambda run: run.control.set_breakpoints([AT_TWO]),
        0.8: lambda run: run.control.set_breakpoints([]),
        0.9: lambda run: run.control.repeat("root/one"),
        1.0: lambda run: run.control.attach_operator(),
        9.0: lambda run: run.control.answer("root/one"),
        9.5: lambda run: run.control.force("root/two", "a"),
    }
    ran = operate(LINE, acts)
    commands = [event for event in ran.events if isinstance(event, OperatorCommanded)]
    assert [(event.time_s, event.command, event.path, event.arguments) for event in commands] == [
        (0.1, "pause", "", {}),
        (0.2, "step", "", {"mode": "over"}),
        (0.3, "resume", "", {}),
        (0.4, "lock", "root/two", {"reason": "look first"}),
        (0.5, "unlock", "root/two", {}),
        (0.6, "autonomy", "", {"level": "low"}),
        (0.7, "breakpoints", "", {"breakpoints": [{"path": "root/two"}]}),
        (0.8, "breakpoints", "", {"breakpoints": []}),
        (0.9, "repeat", "root/one", {}),
        (9.0, "answer", "root/one", {"outcome": "a"}),
        (9.5, "force", "root/two", {"outcome": "a"}),
    ]


def test_a_node_waits_once_and_passes_once_whatever_is_commanded_elsewhere() -> None:
    acts: dict[float, Act] = {
        1.0: lambda run: run.control.lock("root/one"),
        5.0: lambda run: run.control.lock("root/two"),
        6.0: lambda run: run.control.unlock("root/two"),
        7.0: lambda run: run.control.unlock("root/one"),
    }
    ran = operate(LINE, acts)
    assert gates(ran.events) == [(2.0, "waits", "after", "root/one"), (7.0, "passes", "after", "root/one")]


@pytest.mark.parametrize(
    ("condition", "told"),
    [
        (
            "n + 1",
            "breakpoint root/two: root/two: the condition of the breakpoint evaluates to 4, which is not a boolean",
        ),
        ("m > 1", "breakpoint root/two: "),
    ],
)
def test_a_condition_that_cannot_be_decided_pauses_the_run_and_says_why(condition: str, told: str) -> None:
    """The run does not end by it, and the mistake is seen."""
    at = RunOptions(breakpoints=(Breakpoint(path="root/two", condition=condition),))
    ran = operate(LINE, {9.0: resume}, supervision=at)
    assert (ran.result.outcome, ran.result.duration_s) == ("good", 13.0)
    said = [event.message for event in ran.events if isinstance(event, MessageLogged)]
    assert said[0].startswith(told)
    assert said[1] == "breakpoint before root/two"


def test_a_breakpoint_that_is_hit_says_so() -> None:
    ran = operate(LINE, {9.0: resume}, supervision=RunOptions(breakpoints=(AT_TWO,)))
    assert [(e.time_s, e.path, e.message) for e in ran.events if isinstance(e, MessageLogged)] == [
        (2.0, "root/two", "breakpoint before root/two")
    ]


def test_an_outcome_that_waits_passes_when_the_autonomy_is_raised() -> None:
    acts: dict[float, Act] = {5.0: lambda run: run.control.set_autonomy("full")}
    ran = operate(LINE, acts, supervision=RunOptions(autonomy="high", demand_operator=True))
    assert (ran.result.outcome, ran.result.duration_s) == ("good", 9.0)
    assert [event.time_s for event in ran.events if isinstance(event, OutcomeRequested)] == [2.0]


def test_an_answer_is_for_one_outcome_and_not_for_the_next_of_the_same_node() -> None:
    """An order in its place does not leave it behind either."""
    acts: dict[float, Act] = {
        5.0: lambda run: (run.control.answer("root/one"), run.control.repeat("root/one")),
        30.0: lambda run: run.control.answer("root/one"),
    }
    ran = operate(LINE, acts, supervision=RunOptions(autonomy="high", demand_operator=True))
    assert [event.time_s for event in ran.events if isinstance(event, OutcomeRequested)] == [2.0, 7.0]
    assert (ran.result.outcome, ran.result.duration_s) == ("good", 34.0)


def test_who_has_asked_nothing_is_answered_with_who_has() -> None:
    said: list[str] = []

    def wrong(run: Run) -> None:
        with pytest.raises(ControlError) as refused:
            run.control.answer("root/two")
        said.append(str(refused.value))

    at = RunOptions(autonomy="high", demand_operator=True)
    operate(LINE, {3.0: wrong, 4.0: end}, supervision=at)
    assert said == ["root/two: this node has requested no outcome (did you mean root/one?)"]


def test_a_step_lets_go_the_branch_that_is_asked_for_and_no_other() -> None:
    acts: dict[float, Act] = {
        0.5: pause,
        0.6: lambda run: run.control.step(),
        10.0: lambda run: run.control.step("into", "root/right"),
        12.0: lambda run: run.control.step("into", "root/right"),
        20.0: end,
    }
    ran = operate(BRANCHES, acts)
    entered = [(e.time_s, e.path) for e in ran.events if isinstance(e, NodeEntered) and e.path.endswith("/two")]
    assert [path for _, path in entered] == ["root/right/two"]


def test_an_outcome_that_nobody_may_choose_is_refused_though_the_node_waits() -> None:
    said: list[str] = []

    def wrong(run: Run) -> None:
        for command in (
            lambda: run.control.lock("root/tow"),
            lambda: run.control.repeat("root/two"),
            lambda: run.control.force("root/two", "a"),
            lambda: run.control.force("root/one", "left"),
        ):
            with pytest.raises(ControlError) as refused:
                command()
            said.append(str(refused.value).partition(" (")[0])

    ran = operate(LINE, {1.0: wrong})
    assert said == [
        "root/tow: there is no such node",
        "root/two: this node is not active",
        "root/two: this node is not active",
        "root/one: there is no outcome 'left'",
    ]
    assert not [event for event in ran.events if isinstance(event, OperatorCommanded)]


def test_a_run_is_still_when_it_is_paused_and_executes_nothing_else() -> None:
    """Only then is a step taken back; a run that has ended is not still."""
    said: list[str] = []

    def ask(run: Run) -> None:
        try:
            run.control.require_still()
            said.append("still")
        except ControlError as error:
            said.append(error.message)

    kept: list[Run] = []
    acts: dict[float, Act] = {
        0.1: kept.append,
        0.5: ask,
        1.0: pause,
        1.5: ask,
        2.0: lambda run: run.control.step(),
        2.5: ask,
        9.0: ask,
        10.0: end,
    }
    operate(LINE, acts)
    ask(kept[0])
    assert (kept[0].control.closed, kept[0].control.demanded) == (True, False)
    assert said == [
        "the run is not paused",
        "still",
        "the run is executing another command",
        "still",
        "the run is not paused",
    ]


def test_a_node_that_waits_follows_the_order_of_the_operator() -> None:
    """Its lock holds the outcome that it had, not the one that is chosen."""
    acts: dict[float, Act] = {
        1.0: lambda run: run.control.lock("root/one"),
        5.0: lambda run: run.control.force("root/one", "c"),
    }
    ran = operate(LINE, acts)
    assert (ran.result.outcome, ran.result.duration_s) == ("bad", 5.0)


def test_a_node_that_runs_again_is_held_by_the_next_pause_like_any_other() -> None:
    """It was let go to clean up, for that alone."""
    acts: dict[float, Act] = {
        0.5: pause,
        1.0: lambda run: run.control.repeat("root/one"),
        10.0: resume,
        11.0: pause,
        21.0: resume,
    }
    ran = operate(LINE, acts)
    assert [(e.time_s, e.path) for e in ran.events if isinstance(e, NodeEntered) and e.path != "root"] == [
        (0.0, "root/one"),
        (10.0, "root/one"),
        (22.0, "root/two"),
    ]

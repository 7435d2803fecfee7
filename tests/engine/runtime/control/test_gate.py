"""Steps, breakpoints, locks, orders and autonomy at the gate of a run."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from engine.errors import ControlError
from engine.event import Event, GateReached, OperatorCommanded, OutcomeRequested, OutcomeWithdrawn
from engine.runtime.control import Breakpoint
from engine.runtime.control.single_step import StepMode
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from tests.engine.runtime.control.operate import Act, operate, resume

NESTED = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, transitions: {a: two, b: two, c: bad}}
      two:
        machine:
          initial: left
          states:
            left: {state: test.Give, with: {after_s: 1}, transitions: {a: right, b: right, c: bad}}
            right: {state: test.Give, with: {after_s: 1}, transitions: {a: out, b: out, c: bad}}
        transitions: {out: three, bad: bad}
      three: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: good, c: bad}}
"""


def step(mode: StepMode) -> Act:
    return lambda run: run.control.step(mode)


def stops(events: Sequence[Event]) -> list[str]:
    return [f"{e.point} {e.path}" for e in events if isinstance(e, GateReached)]


INTO: tuple[StepMode, ...] = ("into", "into", "into", "into", "into")
B = "before root"
DEEP = [B, f"{B}/one", f"{B}/two", f"{B}/two/left"]
WAYS: dict[str, tuple[tuple[StepMode, ...], list[str]]] = {
    "into": (INTO, [*DEEP, f"{B}/two/right", f"{B}/three"]),
    "over": (("into", "over", "over"), [B, f"{B}/one", f"{B}/two", f"{B}/three"]),
    "out": (("into", "into", "into", "out"), [*DEEP, "after root/two"]),
}


@pytest.mark.parametrize(("modes", "expected"), WAYS.values(), ids=WAYS)
def test_steps_stop_where_they_say(modes: tuple[StepMode, ...], expected: list[str]) -> None:
    acts = {10.0 * (i + 1): step(mode) for i, mode in enumerate(modes)}
    told = operate(NESTED, {**acts, 500.0: resume}, supervision=RunOptions(start_paused=True))
    assert stops(told.events) == expected
    assert told.result.outcome == "good"


def test_a_breakpoint_pauses_before_and_after_by_condition_and_hits() -> None:
    text = """
    userdata: {count: 0}
    root:
      machine:
        initial: count
        states:
          count: {state: test.Count, with: {up_to: 5}, transitions: {more: wait, full: good}}
          wait: {state: test.Give, with: {after_s: 1}, transitions: {a: count, b: count, c: bad}}
    """
    at = RunOptions(breakpoints=(Breakpoint(path="root/wait", condition="count >= 2", hits=2),))
    told = operate(text, {100.0: resume, 200.0: resume}, supervision=at)
    reached = [e for e in told.events if isinstance(e, GateReached)]
    assert [(e.path, e.visit, e.point) for e in reached] == [("root/wait", 3, "before"), ("root/wait", 4, "before")]
    assert told.result.outcome == "good"


def test_a_lock_holds_the_outcome_of_a_container_and_not_what_is_inside() -> None:
    told = operate(
        NESTED, {0.5: lambda run: run.control.lock("root/two"), 30.0: lambda run: run.control.unlock("root/two")}
    )
    assert stops(told.events) == ["after root/two"]
    assert told.result.duration_s == pytest.approx(31.0)


def test_the_reason_of_a_lock_is_in_its_event() -> None:
    told = operate(
        NESTED,
        {
            0.2: lambda run: run.control.lock("root/two", "the tray is being changed"),
            0.3: lambda run: run.control.lock("root/one"),
            0.4: lambda run: (run.control.unlock("root/one"), run.control.unlock("root/two")),
        },
    )
    locks = [event for event in told.events if isinstance(event, OperatorCommanded) and event.command == "lock"]
    assert [(event.path, event.arguments) for event in locks] == [
        ("root/two", {"reason": "the tray is being changed"}),
        ("root/one", {}),
    ]


def test_a_forced_outcome_preempts_what_runs_and_takes_its_transition() -> None:
    told = operate(NESTED, {0.5: lambda run: run.control.force("root/two", "bad")})
    assert told.result.outcome == "bad"
    assert told.lines[-4:-1] == ["+root/two/left", "-root/two/left preempted", "-root/two preempted"]
    assert told.result.cause is not None
    assert "forced by the operator" in str(told.result.cause)


def test_a_repeat_runs_a_node_again() -> None:
    told = operate(NESTED, {0.5: lambda run: run.control.repeat("root/two/left")})
    assert told.result.duration_s == pytest.approx(3.5)
    assert told.lines.count("+root/two/left") == 2


def test_orders_to_what_is_not_there_say_so_and_change_nothing() -> None:
    said: list[str] = []

    def wrong(run: Run) -> None:
        for order in (
            lambda: run.control.force("root/two", "nothing"),
            lambda: run.control.force("root/three", "a"),
            lambda: run.control.repeat("root/tow"),
            lambda: run.control.unlock("root/two"),
            lambda: run.control.answer("root/two"),
            lambda: run.control.step("into"),
        ):
            with pytest.raises(ControlError) as refusal:
                order()
            said.append(str(refusal.value))

    told = operate(NESTED, {0.5: wrong})
    assert told.result.outcome == "good"
    assert [line.partition(" (")[0] for line in said] == [
        "root/two: there is no outcome 'nothing'",
        "root/three: this node is not active",
        "root/tow: there is no such node",
        "root/two: this node is not locked",
        "root/two: this node has requested no outcome",
        "the run is not paused",
    ]


AUTONOMY = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, autonomy: {a: high}, transitions: {a: two, b: bad, c: bad}}
      two: {state: test.Give, autonomy: {a: low}, transitions: {a: good, b: good, c: bad}}
"""


def test_outcomes_pass_by_themselves_below_the_level_and_others_ask_once() -> None:
    at = RunOptions(autonomy="high", demand_operator=True)
    told = operate(AUTONOMY, {5.0: lambda run: run.control.answer("root/one")}, supervision=at)
    assert [(e.path, e.required) for e in told.events if isinstance(e, OutcomeRequested)] == [("root/one", "high")]
    assert (told.result.outcome, told.result.duration_s) == ("good", 5.0)


def test_without_operator_there_are_no_rules() -> None:
    told = operate(AUTONOMY, {}, supervision=RunOptions(autonomy="off"))
    assert told.result.duration_s == 0.0


def test_a_request_is_withdrawn_when_the_node_is_preempted() -> None:
    at = RunOptions(autonomy="low", demand_operator=True)
    told = operate(AUTONOMY, {5.0: lambda run: run.stop("enough")}, supervision=at)
    assert told.result.status == "stopped"
    assert [type(e) for e in told.events if isinstance(e, OutcomeRequested | OutcomeWithdrawn)] == [
        OutcomeRequested,
        OutcomeWithdrawn,
    ]

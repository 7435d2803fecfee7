"""No document keeps the loop: costly expressions, repetitions and rounds give way, or are refused."""

from __future__ import annotations

import asyncio

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.event import NodeEntered
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.run_document import ObservedRun, plan_of, run_document

XS = f"[{', '.join(map(str, range(250)))}]"
COSTLY = f"""
    userdata: {{xs: {XS}, count: 0}}
    root:
      machine:
        initial: count
        states:
          count:
            state: test.Count
            with: {{up_to: "${{size(xs.map(x, x)) - 200}}"}}
            transitions: {{more: count, full: good}}
"""


def test_costly_expressions_in_a_row_let_others_have_a_turn() -> None:
    """Between two turns of another task there are never more than two evaluations of the largest cost."""
    longest, spent = run_virtual(_beside_a_ticker(COSTLY))
    assert spent > 10 * MAX_STEPS
    assert longest <= 3 * MAX_STEPS


async def _beside_a_ticker(text: str) -> tuple[float, float]:
    """Run a document; return the most steps between two turns of another task, and all of them."""
    run = Run(plan_of(text), run="r", bus=SkillBus(new_clock()))
    began = last = METER.spent
    longest = 0.0
    running: asyncio.Task[RunResult] = asyncio.ensure_future(run.execute())
    while not running.done():
        longest, last = max(longest, METER.spent - last), METER.spent
        await asyncio.sleep(0)
    assert running.result().outcome == "good"
    return max(longest, METER.spent - last), METER.spent - began


@pytest.mark.parametrize(
    ("userdata", "value"),
    [
        (f"xs: {XS}", "${xs}"),
        ("xs: [1], none: []", "${none.exists(x, (none in xs.map(y, xs.map(z, y))) == none)}"),
    ],
)
def test_what_is_done_for_an_expression_counts_too(userdata: str, value: str) -> None:
    """Copying and measuring what it reads, going through its syntax: that may take longer than the evaluation."""
    entered = run_virtual(_most_entered(REPEATED.format(userdata=userdata, value=value)))
    assert entered <= MOST_ENTRIES


MOST_ENTRIES = 200
"""Where nothing is counted, states give way after 256."""
REPEATED = """
    userdata: {{count: 0, {userdata}}}
    root:
      machine:
        initial: write
        states:
          write: {{state: test.Write, with: {{value: "{value}"}}, transitions: {{done: count}}}}
          count: {{state: test.Count, with: {{up_to: 600}}, transitions: {{more: write, full: good}}}}
"""


async def _most_entered(text: str) -> int:
    """Run a document; return how often a state was entered at most between two turns of another task."""
    run = Run(plan_of(text), run="r", bus=SkillBus(new_clock()))
    entered = [0]
    run.watch(lambda event: entered.append(entered.pop() + isinstance(event, NodeEntered)))
    longest = 0
    running: asyncio.Task[RunResult] = asyncio.ensure_future(run.execute())
    while not running.done():
        entered[-1] = 0
        await asyncio.sleep(0)
        longest = max(longest, entered[-1])
    assert running.result().outcome == "good"
    return longest


def test_two_runs_count_alike() -> None:
    """Turns are given by what was counted, so the same document has the same events."""
    assert run_document(COSTLY).lines == run_document(COSTLY).lines


def test_a_tree_of_costly_guards_gives_way_inside_a_tick() -> None:
    """Twenty guards, each of nearly the largest cost."""
    guard = '{guard: {when: "${size(xs.map(x, x)) > 0}", child: {state: test.Give, with: {outcome: a}, success: [a]}}}'
    text = f"""
    userdata: {{xs: {XS}}}
    root:
      machine:
        initial: tree
        states:
          tree:
            tree:
              sequence: [{", ".join([guard] * 20)}]
            transitions: {{success: good, failure: bad}}
    """
    longest, spent = run_virtual(_beside_a_ticker(text))
    assert spent > 10 * MAX_STEPS
    assert longest <= 4 * MAX_STEPS


def test_a_state_that_fails_at_once_is_repeated_a_million_times_without_keeping_the_loop() -> None:
    """The doubled wait of the 1,100th repetition is still a number, and a stop comes through."""
    told = run_document(
        """
    root:
      machine:
        initial: fail
        states:
          fail: {state: test.Raise, retry: {times: 1000000}, transitions: {done: good}}
    """,
        stop_at_s=0.0,
    )
    assert told.result.cause is None or "OverflowError" not in told.result.cause.message
    assert len(told.events) < 10_000


@pytest.mark.parametrize(
    ("rounds", "says"),
    [
        ("{times: 9000000000000, child: {state: test.Give, with: {outcome: a}}}", "9,000,000,000,000 rounds"),
        ("{times: '${9223372036854775807 - n}', n: 0}", "rounds"),
    ],
)
def test_more_rounds_than_anybody_counts_are_refused(rounds: str, says: str) -> None:
    """Nobody makes a list of so many numbers."""
    child = "child: {state: test.Give, with: {outcome: a}}"
    told = _run_foreach(rounds.replace("n: 0", child))
    assert told.result.cause is not None
    assert says in told.result.cause.message


def _run_foreach(rounds: str) -> ObservedRun:
    return run_document(f"""
    userdata: {{n: 1}}
    root:
      machine:
        initial: each
        states:
          each: {{foreach: {rounds}, transitions: {{exhausted: good, broken: bad}}}}
    """)


def test_text_that_doubles_in_a_loop_ends_the_run_with_the_key_and_the_node() -> None:
    """The error says where the growth is."""
    told = run_document(
        """
    userdata: {text: aaaaaaaaaaaaaaaaaaaaaaaa}
    root:
      machine:
        initial: write
        states:
          write: {state: test.Write, with: {value: "${text + text}"}, out: {value: text}, transitions: {done: write}}
    """
    )
    assert told.result.cause is not None
    assert "`value`" in str(told.result.cause)
    assert "root/write" in str(told.result.cause)

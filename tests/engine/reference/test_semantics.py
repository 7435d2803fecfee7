"""The engine and the reference interpreter tell the same of random behaviors, to the instant."""

from __future__ import annotations

import random

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from engine.event import RunEnded, RunStarted
from engine.journal import encode_event_log
from tests.engine.reference.activation import activation_lines, lines_of
from tests.engine.reference.engine_run import run_to_end
from tests.engine.reference.interpreter import Interpreter, TooLong
from tests.engine.reference.random_behaviors import STOPS, Case, cases, preempting_cases
from tests.engine.reference.schedule import Schedule
from tests.tiers import examples

ORDERS = 12
"""Orders of the branches of an instant that are tried to see whether they matter."""
COMPARING = settings(
    max_examples=examples(40, nightly=300),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much],
)


@given(cases(), STOPS)
@settings(COMPARING, max_examples=examples(60, nightly=1000))
def test_the_engine_does_what_the_reference_does(case: Case, stop_at_s: float) -> None:
    """Status, outcome, userdata, and every activation with its times."""
    compare(case, stop_at_s)


@given(preempting_cases(), STOPS)
@settings(COMPARING, max_examples=examples(50, nightly=1000))
def test_conditions_preempt_the_branches_that_the_reference_preempts(case: Case, stop_at_s: float) -> None:
    """While the others go on."""
    compare(case, stop_at_s)


@pytest.mark.nightly
@pytest.mark.timeout(3600)
@given(cases() | preempting_cases(), STOPS)
@settings(COMPARING, max_examples=10_000)
def test_the_engine_does_what_the_reference_does_ten_thousand_times(case: Case, stop_at_s: float) -> None:
    """As above."""
    compare(case, stop_at_s)


def compare(case: Case, stop_at_s: float) -> None:
    """Let both run it, where it does not matter who writes a shared key first at one instant."""
    reference = Interpreter(case.behavior)
    try:
        status, outcome, userdata = reference.run(stop_at_s)
    except TooLong:
        assume(False)
        raise
    if case.shares:
        mine = (status, outcome, userdata, activation_lines(reference.log))
        assume(all(_in_any_order(case, stop_at_s, seed) == mine for seed in range(ORDERS)))
    told = run_to_end(case.behavior, stop_at_s)
    result = told.result
    assert activation_lines(lines_of(told.events)) == activation_lines(reference.log)
    assert (result.status, result.outcome, dict(result.userdata)) == (status, outcome, userdata)


def _in_any_order(case: Case, stop_at_s: float, seed: int) -> tuple[object, ...]:
    """What becomes of it when branches take turns by chance at each instant."""
    reference = Interpreter(case.behavior, schedule=Schedule(random.Random(seed)))
    try:
        return (*reference.run(stop_at_s), activation_lines(reference.log))
    except TooLong:
        return ()


@given(cases(), st.sampled_from([0.0, 1.0, 2.0, 3.0, 4.0, 12.05]))
@COMPARING
def test_a_run_ends_and_leaves_nothing_behind(case: Case, stop_at_s: float) -> None:
    """Stopped at the instants of other things: numbered without gaps, all left once, nothing after the end."""
    try:
        Interpreter(case.behavior).run(12.05)
    except TooLong:
        assume(False)
    told = run_to_end(case.behavior, stop_at_s)
    activation_lines(lines_of(told.events))
    assert [event.seq for event in told.events] == list(range(1, len(told.events) + 1))
    assert [event.time_s for event in told.events] == sorted(event.time_s for event in told.events)
    assert isinstance(told.events[0], RunStarted)
    ends = [event for event in told.events if isinstance(event, RunEnded)]
    assert told.events[-1:] == tuple(ends)
    assert (ends[0].status, ends[0].outcome) == (told.result.status, told.result.outcome)
    assert told.result.status in ("finished", "stopped", "errored")
    assert (told.result.outcome is not None) == (told.result.status == "finished")


@given(cases(), STOPS | st.sampled_from([0.0, 1.0, 2.0]), st.integers(0, 3))
@settings(COMPARING, max_examples=examples(30, nightly=300))
def test_the_same_seed_gives_the_same_bytes(case: Case, stop_at_s: float, seed: int) -> None:
    """Twice the same run, whatever happens at one instant."""
    try:
        Interpreter(case.behavior).run(12.05)
    except TooLong:
        assume(False)
    first, second = (encode_event_log(run_to_end(case.behavior, stop_at_s, seed).events) for _ in range(2))
    assert first == second

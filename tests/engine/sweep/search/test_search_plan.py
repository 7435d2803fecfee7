"""A search as batches."""

from __future__ import annotations

import pytest

from benchmarks.failure_search import CASES, searched
from engine.errors import FlexcellError
from engine.sweep.search.search_plan import SearchPlan

CORNER = CASES[2]


def test_it_ends_with_the_run_that_is_the_last_failure_wanted() -> None:
    plan = searched(CORNER, CORNER.sweep(1, runs=2000, stop_after=3))
    assert (plan.failures, plan.is_satisfied, len(plan.due())) == (3, True, 0)
    assert not plan.steps[-1].result.success
    assert plan.steps == searched(CORNER, CORNER.sweep(1, runs=2000, stop_after=5)).steps[: len(plan.steps)]


def test_the_last_batch_is_as_long_as_runs_are_left() -> None:
    plan = searched(CORNER, CORNER.sweep(1, runs=50, batch=20))
    assert [step.point.batch for step in plan.steps] == [0] * 20 + [1] * 20 + [2] * 10
    assert [step.point.configuration.number for step in plan.steps] == list(range(50))


@pytest.mark.parametrize("method", ["cross_entropy", "optuna"])
def test_a_number_that_no_run_has_ends_it_after_the_first_batch(method: str) -> None:
    with pytest.raises(FlexcellError, match="no run has a number `distanze`") as caught:
        searched(CORNER, CORNER.sweep(1, towards="least distanze", method=method))
    assert "distance" in str(caught.value.hint)


def test_optuna_finds_planted_failures_with_the_same_runs_each_time() -> None:
    ball = CASES[0]
    plans = [searched(ball, ball.sweep(3, runs=120, batch=10, method="optuna")) for _ in range(2)]
    assert plans[0].steps == plans[1].steps
    assert plans[0].failures > 0
    assert {step.point.weight for step in plans[0].steps} == {None}
    short = searched(ball, ball.sweep(3, runs=45, batch=10, method="optuna"))
    assert plans[0].steps[:45] == short.steps


def test_optuna_searches_lists_too() -> None:
    case = CASES[3]
    assert searched(case, case.sweep(1, runs=120, method="optuna")).failures > 0


def test_a_partial_batch_ends_with_what_there_is() -> None:
    plan = SearchPlan(CORNER.sweep(1, runs=50, batch=20))
    batch = plan.due()
    plan.take([CORNER.result(point.configuration) for point in batch[:7]])
    assert [step.point for step in plan.steps] == list(batch[:7])

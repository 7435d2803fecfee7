"""Cross-entropy on planted failures: far fewer runs than at random, honest weights, and the same whatever happens."""

from __future__ import annotations

import math

import pytest

from benchmarks.failure_search import CASES, PlantedCase, runs_to_first, searched
from engine.sweep import TrialResult, configurations
from engine.sweep.search.sampler import SearchPoint
from engine.sweep.search.search_plan import SearchPlan

SEEDS = 100
BALL, SLAB, CORNER, VALUE, MISLEADING = CASES


@pytest.mark.parametrize("case", [BALL, SLAB, CORNER, VALUE], ids=lambda case: case.name)
def test_a_planted_failure_is_found_in_less_than_half_the_runs_of_a_random_design(case: PlantedCase) -> None:
    """In 95 of 100 searches at least; a random design needs ln 2 / probability runs in the median."""
    most = math.floor(math.log(2.0) / case.probability / 2.0)
    assert case.probability <= 0.002
    found = sum(searched(case, case.sweep(seed, runs=most, stop_after=1)).failures for seed in range(SEEDS))
    assert found >= 95


def test_a_number_that_misleads_does_not_keep_it_from_failures() -> None:
    """At random, one search in 150 would take more than 500 runs."""
    found = [runs_to_first(MISLEADING, seed, runs=1000) for seed in range(40)]
    assert sum(runs > 500 for runs in found) <= 2


def test_without_a_number_failures_at_the_ends_of_factors_are_found_sooner_than_at_random() -> None:
    """At random, 30 of 40 searches find one in 138 runs."""
    found = [searched(MISLEADING, MISLEADING.sweep(seed, runs=138, towards="failure")) for seed in range(40)]
    assert sum(plan.failures > 0 for plan in found) >= 37


def test_the_first_batch_is_that_of_a_random_design_and_so_is_what_is_drawn_as_written() -> None:
    plan = SearchPlan(BALL.sweep(5, batch=20, random_share=0.5))
    random_ones = list(configurations(BALL.sweep(5)))
    first = plan.due()
    assert [point.configuration for point in first] == random_ones[:20]
    assert {(point.weight, point.most_weight) for point in first} == {(1.0, 1.0)}
    plan.take([BALL.result(point.configuration) for point in first])
    second = plan.due()
    as_written = sum(point.configuration == random_ones[point.configuration.number] for point in second)
    assert 4 <= as_written <= 16
    assert all(0.0 < (point.weight or 0.0) <= point.most_weight == 2.0 for point in second)


def test_the_same_results_give_the_same_search() -> None:
    first, second = (searched(CORNER, CORNER.sweep(7, runs=130)) for _ in range(2))
    assert first.steps == second.steps
    assert len(first.steps) == 130
    assert first.steps != searched(CORNER, CORNER.sweep(8, runs=130)).steps


def test_a_longer_search_begins_with_a_shorter_one() -> None:
    short, long = (searched(SLAB, SLAB.sweep(7, runs=runs)).steps for runs in (50, 90))
    assert long[:50] == short


def test_a_run_that_is_refused_draws_nothing_near() -> None:
    """Large values are refused, and the middle comes nearest to failure: the search goes there and finds nothing."""
    plan = SearchPlan(BALL.sweep(2, runs=100))
    shares: list[float] = []
    while batch := plan.due():
        shares = [each.shares[0] for each in batch]
        plan.take([_refused_above(0.6, each) for each in batch])
    assert plan.failures == 0
    assert sum(share > 0.6 for share in shares) < 0.4 * len(shares)


def _refused_above(limit: float, point: SearchPoint) -> TrialResult:
    share = point.shares[0]
    return TrialResult(
        configuration=point.configuration,
        status="refused" if share > limit else "finished",
        success=share <= limit,
        outputs={"distance": abs(share - 0.5)},
    )

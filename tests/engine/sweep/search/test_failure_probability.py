"""The failure probability that a search estimates, on planted truths."""

from __future__ import annotations

import math
import random
import statistics

import pytest

from benchmarks.failure_search import CASES, PlantedCase, searched
from engine.sweep import Configuration, TrialResult
from engine.sweep.search.failure_probability import FailureProbability, failure_probability
from engine.sweep.search.sampler import SearchPoint
from engine.sweep.search.search_plan import SearchStep

BALL, _, CORNER, VALUE, MISLEADING = CASES


def _step(number: int, *, fails: bool, weight: float | None = 1.0, most_weight: float = 1.0) -> SearchStep:
    configuration = Configuration(number=number, seed=0, values={})
    point = SearchPoint(configuration=configuration, batch=0, shares=(), weight=weight, most_weight=most_weight)
    return SearchStep(point, TrialResult(configuration=configuration, status="finished", success=not fails))


def _found(case: PlantedCase, seed: int, runs: int, **search: object) -> FailureProbability:
    found = failure_probability(searched(case, case.sweep(seed, runs=runs, **search)).steps, runs)
    assert found is not None
    return found


@pytest.mark.parametrize("case", [BALL, CORNER, VALUE, MISLEADING], ids=lambda case: case.name)
def test_the_mean_estimate_of_many_searches_is_the_truth(case: PlantedCase) -> None:
    found = [_found(case, seed, 200) for seed in range(60)]
    estimates = [each.estimate for each in found]
    error = statistics.stdev(estimates) / math.sqrt(len(estimates))
    assert abs(statistics.mean(estimates) - case.probability) < 3.0 * error
    missed = sum(not each.interval.low <= case.probability <= each.interval.high for each in found)
    assert missed <= 5


def test_the_interval_holds_where_failures_end_the_search() -> None:
    """The estimate then leans high: one failure in few runs."""
    found = [_found(MISLEADING, seed, 400, stop_after=1) for seed in range(60)]
    assert statistics.mean(each.estimate for each in found) > MISLEADING.probability
    assert sum(not each.interval.low <= MISLEADING.probability <= each.interval.high for each in found) <= 5


@pytest.mark.parametrize("rate", [0.02, 0.4])
def test_random_runs_alone_have_an_interval_too(rate: float) -> None:
    missed, widths = 0, list[float]()
    for seed in range(60):
        source = random.Random(f"{rate} {seed}")
        found = failure_probability([_step(number, fails=source.random() < rate) for number in range(200)], 200)
        assert found is not None
        missed += not found.interval.low <= rate <= found.interval.high
        widths.append(found.interval.width)
    assert missed <= 5
    assert statistics.median(widths) < 0.25


def test_without_a_failure_the_interval_begins_at_zero_and_gets_narrower() -> None:
    found = [failure_probability([_step(n, fails=False) for n in range(runs)], runs) for runs in (20, 200)]
    assert all(each is not None and each.estimate == each.interval.low == 0.0 for each in found)
    few, many = (each.interval.high for each in found if each is not None)
    assert 0.5 > few > 3.0 * many > 0.0


def test_a_failure_weighs_as_much_as_it_is_likely() -> None:
    steps = [_step(0, fails=True, weight=0.02, most_weight=5.0), *(_step(n, fails=False) for n in range(1, 10))]
    found = failure_probability(steps, 10)
    assert found is not None
    assert (found.estimate, found.effective_failures) == (pytest.approx(0.002), pytest.approx(1.0))


def test_unknown_weights_give_no_estimate() -> None:
    assert failure_probability([_step(0, fails=True, weight=None)], 1) is None
    assert failure_probability([], 10) is None

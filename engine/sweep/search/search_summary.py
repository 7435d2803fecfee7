"""What a search has found: failures by cause and where they are, the nearest successes, and how it got there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from engine.document.sweep import Factor, SearchSpec, Sweep
from engine.sweep.design.distributions import share_of
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.search.failure_probability import FailureProbability, failure_probability
from engine.sweep.search.search_execution import SearchEnd, SearchEndedBy
from engine.sweep.search.search_plan import SearchStep
from engine.sweep.search.target import SearchTarget, is_failure
from engine.sweep.summary import CauseGroup, cause_groups


@dataclass(frozen=True, kw_only=True)
class FactorRegion:
    """The values of a factor with which runs failed alike; the search chose them, so that they are no random sample."""

    address: str
    listed: bool
    """Whether it has a list of values, else a distribution of numbers."""
    failing: Sequence[object]
    """The least and largest number; or all values of a list."""
    executed: Sequence[object]
    """The same of all runs."""
    share: float
    """The probability of the failing range or values under the written distribution."""
    passed_inside: int
    """The runs that succeeded with a value in there."""


@dataclass(frozen=True, kw_only=True)
class FailureCluster:
    """Failing runs with the same root cause, and where they are."""

    cause: CauseGroup
    regions: Sequence[FactorRegion]
    """The factors that tell most come first; none of fewer than three runs, whose ranges say nothing."""


@dataclass(frozen=True, kw_only=True)
class BatchTrace:
    """What one batch has shown."""

    batch: int
    runs: int
    failures: int
    refused: int
    nearest: float | None
    """The number that is searched for, of the run that succeeded and is nearest to failure."""


@dataclass(frozen=True, kw_only=True)
class SearchSummary:
    """What a search has found. Its runs are chosen, so that their success rate says nothing of the behavior."""

    sweep: Sweep
    subject: str
    versions: Mapping[str, str]
    spec: SearchSpec
    target: SearchTarget
    ended_by: SearchEndedBy
    steps: Sequence[SearchStep]
    failing: Sequence[TrialResult]
    refused: int
    clusters: Sequence[FailureCluster]
    nearest: Sequence[TrialResult]
    """The runs that succeeded and are nearest to failure, the nearest first."""
    batches: Sequence[BatchTrace]
    probability: FailureProbability | None
    """Of a failure under the written distributions; None for a method that does not tell how it draws."""
    cpu_s: float

    @property
    def results(self) -> Sequence[TrialResult]:
        """The results in the order of their numbers."""
        return [step.result for step in self.steps]


_NEAREST = 5
_LEAST_OF_REGION = 3


def summarize_search(end: SearchEnd) -> SearchSummary:
    """Return what a search has found until now."""
    document = end.subject.sweep.document
    results = [step.result for step in end.steps]
    failing = [each for each in results if is_failure(each)]
    passed = [each for each in results if each.success and end.target.value(each) is not None]
    return SearchSummary(
        sweep=end.subject.sweep,
        subject=end.subject.hash,
        versions=end.subject.versions,
        spec=end.spec,
        target=end.target,
        ended_by=end.ended_by,
        steps=end.steps,
        failing=failing,
        refused=sum(each.status == "refused" for each in results),
        clusters=_clusters(failing, results, document.factors),
        nearest=sorted(passed, key=end.target.score)[:_NEAREST],
        batches=_batches(end),
        probability=failure_probability(end.steps, end.spec.runs, confidence=document.confidence),
        cpu_s=sum(each.cpu_s for each in results),
    )


def _clusters(
    failing: Sequence[TrialResult], results: Sequence[TrialResult], factors: Mapping[str, Factor]
) -> list[FailureCluster]:
    alike: dict[tuple[str, str], list[TrialResult]] = {}
    for result in failing:
        alike.setdefault(result.cause_key, []).append(result)
    clusters: list[FailureCluster] = []
    for group in sorted(alike.values(), key=lambda each: -len(each)):
        shown = factors if len(group) >= _LEAST_OF_REGION else dict[str, Factor]()
        regions = [_region(name, factor, group, results) for name, factor in shown.items() if name != "seed"]
        # The narrower a range for its likelihood, and the fewer runs succeed in it, the more it tells.
        regions.sort(key=lambda each: (each.share, each.passed_inside))
        clusters.extend(FailureCluster(cause=cause, regions=regions) for cause in cause_groups(group))
    return clusters


def _region(
    address: str, factor: Factor, failing: Sequence[TrialResult], results: Sequence[TrialResult]
) -> FactorRegion:
    bad = [each.configuration.values[address] for each in failing]
    every = [each.configuration.values[address] for each in results]
    good = [each.configuration.values[address] for each in results if each.success]
    if factor.values is not None:
        values = [value for value in factor.values if value in bad]
        return FactorRegion(
            address=address,
            listed=True,
            failing=values,
            executed=[value for value in factor.values if value in every],
            share=len(values) / len(factor.values),
            passed_inside=sum(value in values for value in good),
        )
    numbers, all_numbers = _ordered(bad), _ordered(every)
    low, high = numbers[0], numbers[-1]
    return FactorRegion(
        address=address,
        listed=False,
        failing=(low, high),
        executed=(all_numbers[0], all_numbers[-1]),
        share=(share_of(factor, high) or 0.0) - (share_of(factor, low) or 0.0),
        passed_inside=sum(low <= number <= high for number in _ordered(good)),
    )


def _ordered(values: Sequence[object]) -> list[float]:
    return sorted(value for value in values if isinstance(value, int | float))


def _batches(end: SearchEnd) -> list[BatchTrace]:
    found: list[BatchTrace] = []
    for number in sorted({step.point.batch for step in end.steps}):
        results = [step.result for step in end.steps if step.point.batch == number]
        values = [value for each in results if each.success and (value := end.target.value(each)) is not None]
        found.append(
            BatchTrace(
                batch=number,
                runs=len(results),
                failures=sum(map(is_failure, results)),
                refused=sum(each.status == "refused" for each in results),
                nearest=min(values, key=lambda value: end.target.sign * value, default=None),
            )
        )
    return found

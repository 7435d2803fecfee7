"""What a sweep has shown: rates, causes, durations, coverage and effects of factors, as every report tells it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from engine.coverage import CoverageItem, CoverageRuns
from engine.document.sweep import Sweep
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.statistics import Interval, exact_interval
from engine.sweep.statistics.effects import FactorEffect, RunGroup, factor_effect, quantile
from engine.sweep.statistics.input_coverage import InputCoverage, input_coverage
from engine.sweep.sweep_execution import EndedBy, SweepEnd
from engine.sweep.verdict.judged_requirement import JudgedRequirement, Verdict

_EXAMPLES = 5


@dataclass(frozen=True, kw_only=True)
class OutcomeShare(RunGroup):
    """The runs that ended with one outcome, or status where they had none; the interval is of its share of all."""

    success: bool


@dataclass(frozen=True, kw_only=True)
class CauseGroup:
    """Failed runs with the same innermost cause; numbers in its message may differ between them."""

    at: str
    """The node, device or frame."""
    message: str
    """That of the first run."""
    runs: int
    examples: Sequence[int]
    """The numbers of the first configurations."""


@dataclass(frozen=True, kw_only=True)
class Quantiles:
    """The distribution of a number over runs."""

    name: str
    runs: int
    least: float
    middle: float
    p95: float
    most: float


@dataclass(frozen=True, kw_only=True)
class MeasureSpread:
    """The distribution of a measure over the runs that succeeded, and over those that did not."""

    name: str
    successes: Quantiles | None
    failures: Quantiles | None

    @property
    def least(self) -> float:
        """Its least value in any run."""
        return min(each.least for each in (self.successes, self.failures) if each is not None)

    @property
    def most(self) -> float:
        """Its largest value in any run."""
        return max(each.most for each in (self.successes, self.failures) if each is not None)


@dataclass(frozen=True, kw_only=True)
class SweepSummary:
    """What a sweep has shown. Rates, interval and verdict are of runs without a gap before them; the rest is of all."""

    sweep: Sweep
    subject: str
    versions: Mapping[str, str]
    planned: int
    done: int
    looked_at: int
    successes: int
    interval: Interval | None
    requirements: Sequence[JudgedRequirement]
    verdict: Verdict | None
    ended_by: EndedBy
    outcomes: Sequence[OutcomeShare]
    causes: Sequence[CauseGroup]
    duration_s: Quantiles | None
    """Of runs that succeeded."""
    nodes: Sequence[Quantiles]
    """Seconds in each node a run, those first that take longest."""
    outputs: Sequence[Quantiles]
    """Userdata at the end that are numbers."""
    measures: Sequence[MeasureSpread]
    """In the order of the first result: the run, the world, then each arm and its tool."""
    effects: Sequence[FactorEffect]
    """Those of factors with the largest differences first."""
    inputs: InputCoverage
    """How much of what is varied the runs have covered."""
    items: int
    """What can be covered in the behavior."""
    missing: Sequence[CoverageItem]
    results: Sequence[TrialResult]
    cpu_s: float

    @property
    def rate(self) -> float | None:
        """The success rate of the runs that were looked at."""
        return self.successes / self.looked_at if self.looked_at else None

    @property
    def failing(self) -> Sequence[TrialResult]:
        """The runs that did not succeed."""
        return [result for result in self.results if not result.success]


def summarize(end: SweepEnd) -> SweepSummary:
    """Return what a sweep has shown until now."""
    subject, results, count = end.subject, end.results, end.count
    document = subject.sweep.document
    coverage = CoverageRuns(subject.behavior, subject.catalogue)
    return SweepSummary(
        sweep=subject.sweep,
        subject=subject.hash,
        versions=subject.versions,
        planned=count.planned,
        done=count.done,
        looked_at=count.looked_at,
        successes=count.successes,
        interval=count.interval,
        requirements=count.requirements,
        verdict=count.verdict,
        ended_by=end.ended_by,
        outcomes=_outcomes(results, document.confidence),
        causes=cause_groups(results),
        duration_s=_quantiles("run", [each.duration_s for each in results if each.success]),
        nodes=_node_times(results),
        outputs=_outputs(results),
        measures=_measures(results),
        effects=_effects(end, document.confidence),
        inputs=input_coverage(document.factors, [each.configuration.values for each in results]),
        items=len(coverage.items),
        missing=coverage.missing(each.covered for each in results),
        results=results,
        cpu_s=sum(each.cpu_s for each in results),
    )


def _outcomes(results: Sequence[TrialResult], confidence: float) -> list[OutcomeShare]:
    found: dict[str, list[TrialResult]] = {}
    for result in results:
        found.setdefault(result.label, []).append(result)
    return [
        OutcomeShare(
            label=label,
            runs=len(runs),
            success=runs[0].success,
            interval=exact_interval(len(runs), len(results), confidence=confidence),
        )
        for label, runs in sorted(found.items(), key=lambda item: -len(item[1]))
    ]


def cause_groups(results: Sequence[TrialResult]) -> list[CauseGroup]:
    """Return the failed runs grouped by root cause, the most frequent first."""
    found: dict[tuple[str, str], list[TrialResult]] = {}
    for result in results:
        if not result.success:
            found.setdefault(result.cause_key, []).append(result)
    return [
        CauseGroup(
            at=at,
            message=runs[0].reason or runs[0].label,
            runs=len(runs),
            examples=[each.configuration.number for each in runs[:_EXAMPLES]],
        )
        for (at, _), runs in sorted(found.items(), key=lambda item: -len(item[1]))
    ]


def _node_times(results: Sequence[TrialResult]) -> list[Quantiles]:
    times: dict[str, list[float]] = {}
    for result in results:
        for path, time in result.nodes.items():
            times.setdefault(path, []).append(time.total_s)
    found = [each for path, values in times.items() if (each := _quantiles(path, values)) is not None]
    return sorted(found, key=lambda each: -each.middle)


def _outputs(results: Sequence[TrialResult]) -> list[Quantiles]:
    values: dict[str, list[float]] = {}
    for result in results:
        for key, value in result.outputs.items():
            values.setdefault(key, []).append(value)
    return [each for key, numbers in sorted(values.items()) if (each := _quantiles(key, numbers)) is not None]


def _measures(results: Sequence[TrialResult]) -> list[MeasureSpread]:
    names = dict.fromkeys(name for result in results for name in result.measures)
    return [
        MeasureSpread(
            name=name,
            successes=_quantiles(name, _of_measure(name, results, success=True)),
            failures=_quantiles(name, _of_measure(name, results, success=False)),
        )
        for name in names
    ]


def _of_measure(name: str, results: Sequence[TrialResult], *, success: bool) -> list[float]:
    return [each.measures[name] for each in results if each.success is success and name in each.measures]


def _quantiles(name: str, values: Sequence[float]) -> Quantiles | None:
    if not values:
        return None
    ordered = sorted(values)
    return Quantiles(
        name=name,
        runs=len(ordered),
        least=ordered[0],
        middle=quantile(ordered, 0.5),
        p95=quantile(ordered, 0.95),
        most=ordered[-1],
    )


def _effects(end: SweepEnd, confidence: float) -> list[FactorEffect]:
    results = end.results
    if not results:
        return []
    addresses = list(end.configurations[0].values)
    found = [
        factor_effect(
            address,
            [each.configuration.values[address] for each in results],
            [each.success for each in results],
            [each.duration_s for each in results],
            confidence=confidence,
        )
        for address in addresses
    ]
    return sorted(found, key=lambda each: -each.spread)

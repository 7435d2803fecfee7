"""Whether one version of a behavior, cell or package is worse than another, from the runs that both executed."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass

import msgspec

from engine.errors import FlexcellError
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.results import SweepResults
from engine.sweep.statistics import Interval, RatePair, difference
from engine.sweep.verdict.judged_requirement import Verdict


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Two versions on the same configurations: `pair.only_first` are the runs in which only the baseline succeeded."""

    baseline: str
    """The hash of the versions that are compared with."""
    changed: Sequence[str]
    """What differs between them: names of documents and packages."""
    pair: RatePair
    interval: Interval
    """Of the success rate now minus that of the baseline."""
    margin: float | None
    """How much lower the rate may be; None where nothing is required."""
    broken: Sequence[int]
    """The first configurations that only the baseline executed with success."""

    @property
    def verdict(self) -> Verdict | None:
        """Whether the rate is lower by no more than the margin; None without one."""
        if self.margin is None:
            return None
        if self.interval.low >= -self.margin:
            return "passed"
        return "failed" if self.interval.high < -self.margin else "undecided"


@dataclass(frozen=True, kw_only=True)
class BaselineVersion:
    """Another version that has executed configurations of a sweep."""

    version: str
    """The hash of what all its runs have in common."""
    runs: int
    """The equal configurations that it has executed."""
    successes: int
    changed: Sequence[str]
    """What differs from the version now: names of documents and packages."""
    saved_unix_s: float
    """When its last result was saved."""


_EXAMPLES = 5


def baseline_versions(
    results: Sequence[TrialResult], subject: str, versions: Mapping[str, str], baseline: SweepResults
) -> list[BaselineVersion]:
    """Return the other versions in a file with results of the same configurations, those with most of them first.

    Args:
        results: The results now.
        subject: The hash of their versions.
        versions: Their versions.
        baseline: A file of results.

    Raises:
        FlexcellError: the file cannot be read.
    """
    now = {_configuration(result) for result in results}
    found: list[BaselineVersion] = []
    for other, named in baseline.subjects().items():
        shared = _shared(now, other, baseline) if other != subject else {}
        if shared:
            found.append(
                BaselineVersion(
                    version=other,
                    runs=len(shared),
                    successes=sum(each.success for each in shared.values()),
                    changed=_changed(versions, named),
                    saved_unix_s=baseline.saved_unix_s(other),
                )
            )
    return sorted(found, key=lambda each: -each.runs)


def compare_with_baseline(
    results: Sequence[TrialResult],
    subject: str,
    versions: Mapping[str, str],
    baseline: SweepResults,
    *,
    confidence: float,
    margin: float | None = None,
    version: str | None = None,
) -> Comparison:
    """Compare results with those of another version that has executed the same configurations.

    Args:
        results: The results now.
        subject: The hash of their versions.
        versions: Their versions.
        baseline: A file with results of another version.
        confidence: Of the interval.
        margin: How much lower the rate may be.
        version: The hash of that version; by default the one with most of the configurations.

    Raises:
        FlexcellError: no other version in the file has executed any of the configurations.
    """
    if version is None:
        known = baseline_versions(results, subject, versions, baseline)
        version = known[0].version if known else subject
    now = {_configuration(result): result for result in results}
    before = _shared(now, version, baseline) if version != subject else {}
    if not before:
        raise FlexcellError(
            "no other version has executed the configurations of this sweep",
            where=baseline.path,
            hint="execute the same sweep, with the same seed, with the version to compare with",
        )
    ends = {key: (before[key].success, now[key].success) for key in before}
    counted = {both: sum(each == both for each in ends.values()) for both in set(ends.values())}
    pair = RatePair(
        both=counted.get((True, True), 0),
        only_first=counted.get((True, False), 0),
        only_second=counted.get((False, True), 0),
        neither=counted.get((False, False), 0),
    )
    worse = sorted(now[key].configuration.number for key, each in ends.items() if each == (True, False))
    return Comparison(
        baseline=version,
        changed=_changed(versions, baseline.subjects()[version]),
        pair=pair,
        interval=difference(pair, confidence=confidence),
        margin=margin,
        broken=worse[:_EXAMPLES],
    )


def _shared(now: Container[str], version: str, baseline: SweepResults) -> dict[str, TrialResult]:
    """Return the results of a version by their configuration, of those that were executed now too."""
    return {key: result for result in baseline.all_of(version) if (key := _configuration(result)) in now}


def _changed(versions: Mapping[str, str], others: Mapping[str, str]) -> list[str]:
    return sorted(name for name in {*versions, *others} if versions.get(name) != others.get(name))


def _configuration(result: TrialResult) -> str:
    configuration = result.configuration
    return msgspec.json.encode([configuration.seed, dict(configuration.values)], order="deterministic").decode()

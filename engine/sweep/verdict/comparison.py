"""Whether one version of a behavior, cell or package is worse than another, from the runs that both executed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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


_EXAMPLES = 5


def compare_with_baseline(
    results: Sequence[TrialResult],
    subject: str,
    versions: Mapping[str, str],
    baseline: SweepResults,
    *,
    confidence: float,
    margin: float | None = None,
) -> Comparison:
    """Compare results with those of another version that has executed the same configurations.

    Args:
        results: The results now.
        subject: The hash of their versions.
        versions: Their versions.
        baseline: A file with results of another version; the one with most of the configurations is taken.
        confidence: Of the interval.
        margin: How much lower the rate may be.

    Raises:
        FlexcellError: no other version in the file has executed any of the configurations.
    """
    now = {_configuration(result): result for result in results}
    best: tuple[str, dict[str, TrialResult]] = ("", {})
    known = baseline.subjects()
    for other in known:
        before = {key: result for result in baseline.all_of(other) if (key := _configuration(result)) in now}
        if other != subject and len(before) > len(best[1]):
            best = (other, before)
    if not best[1]:
        raise FlexcellError(
            "no other version has executed the configurations of this sweep",
            where=baseline.path,
            hint="execute the same sweep, with the same seed, with the version to compare with",
        )
    hashed, before = best
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
        baseline=hashed,
        changed=sorted(name for name in {*versions, *known[hashed]} if versions.get(name) != known[hashed].get(name)),
        pair=pair,
        interval=difference(pair, confidence=confidence),
        margin=margin,
        broken=worse[:_EXAMPLES],
    )


def _configuration(result: TrialResult) -> str:
    configuration = result.configuration
    return msgspec.json.encode([configuration.seed, dict(configuration.values)], order="deterministic").decode()

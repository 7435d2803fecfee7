"""How numbers and verdicts of a sweep are written, the same in every report."""

from __future__ import annotations

from engine.sweep.statistics import Interval
from engine.sweep.statistics.input_coverage import FactorCoverage
from engine.sweep.summary import SweepSummary
from engine.sweep.verdict.comparison import Comparison
from engine.sweep.verdict.judged_requirement import JudgedRequirement

REQUIRED_HEAD = ("required", "verdict", "runs that keep it", "share of all runs", "without the number")
"""The heads of `required_rows`."""


def percent(share: float) -> str:
    """Return a share as a percentage; what is not quite everything never reads as 100 %."""
    shown = f"{100.0 * share:.1f}"
    if shown == "100.0" and share < 1.0:
        return "> 99.9 %"
    return f"{shown} %"


def interval_text(interval: Interval) -> str:
    """Return an interval of rates."""
    return f"{percent(interval.low)} to {percent(interval.high)}"


def rate_text(summary: SweepSummary) -> str:
    """Return the success rate with its interval in one sentence."""
    if summary.rate is None:
        return "no run has ended yet"
    text = f"{summary.successes} of {summary.looked_at} runs succeeded ({percent(summary.rate)})"
    if summary.interval is None:
        return text
    confidence = percent(summary.sweep.document.confidence)
    kind = "at any time" if summary.sweep.document.interval == "anytime" else "for this number of runs"
    return f"{text}; the rate is {interval_text(summary.interval)} with {confidence} confidence {kind}"


def verdict_text(summary: SweepSummary) -> str:
    """Return each requirement and whether it is reached; empty where nothing is required."""
    return "; ".join(f"{each.text}: {each.verdict}" for each in summary.requirements)


def kept_text(requirement: JudgedRequirement) -> str:
    """Return how many runs keep a requirement, in one sentence."""
    runs, name = requirement.runs, requirement.number
    text = f"{requirement.kept} of {runs} runs {'succeeded' if name is None else 'keep the limit'}"
    if runs:
        text += f" ({percent(requirement.kept / runs)})"
    if requirement.missing:
        text += f", {requirement.missing} have no number {name}"
    if requirement.interval is None:
        return text
    return f"{text}; the share of all runs is {interval_text(requirement.interval)}"


def required_rows(summary: SweepSummary) -> list[tuple[object, ...]]:
    """Return a row for each requirement; none where only a success rate is required, which is told anyway."""
    required = summary.requirements
    if all(each.number is None for each in required):
        return []
    return [
        (
            each.text,
            each.verdict,
            f"{each.kept} of {each.runs}",
            interval_text(each.interval) if each.interval is not None else "–",
            each.missing,
        )
        for each in required
    ]


def end_text(summary: SweepSummary) -> str:
    """Return why the sweep ended and what is left."""
    left = summary.planned - summary.done
    match summary.ended_by:
        case "runs":
            return "all runs are done" if not left else f"{left} runs are left to other shards"
        case "decided":
            return f"decided after {summary.done} of {summary.planned} runs"
        case "time":
            return f"its time is over, {left} runs are left"
        case "interrupted":
            return f"interrupted, {left} runs are left"


def difference_text(comparison: Comparison) -> str:
    """Return how the success rate has changed, in one sentence."""
    pair, interval = comparison.pair, comparison.interval
    if interval.high < 0.0:
        change = "worse than"
    elif interval.low > 0.0:
        change = "better than"
    else:
        change = "not known to differ from"
    rates = f"{signed(interval.low)} to {signed(interval.high)} points"
    verdict = (
        f"; at most {100.0 * comparison.margin:g} points lower: {comparison.verdict}"
        if comparison.margin is not None
        else ""
    )
    return (
        f"{change} the baseline: {rates} on {pair.runs} equal configurations, {pair.only_second} mended and "
        f"{pair.only_first} broken{verdict}"
    )


def gap_text(coverage: FactorCoverage) -> str:
    """Return the range of a factor without a run and how likely a value in it is; a dash for a list of values."""
    if coverage.gap is None or coverage.gap_share is None:
        return "–"
    low, high = coverage.gap
    return f"{value_text(low)} to {value_text(high)} ({percent(coverage.gap_share)} of its values)"


def signed(share: float) -> str:
    """Return a difference of rates in percentage points."""
    return f"{100.0 * share:+.1f}"


def value_text(value: object) -> str:
    """Return the value of a factor."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)

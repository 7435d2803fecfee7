"""A sweep as Markdown: what a terminal, a pull request and the summary of a CI job show."""

from __future__ import annotations

from collections.abc import Iterator

from engine.sweep.report.tables import markdown_section
from engine.sweep.report.words import (
    REQUIRED_HEAD,
    difference_text,
    end_text,
    gap_text,
    interval_text,
    percent,
    rate_text,
    required_rows,
    value_text,
    verdict_text,
)
from engine.sweep.statistics.effects import FactorEffect
from engine.sweep.statistics.input_coverage import FactorCoverage
from engine.sweep.summary import Quantiles, SweepSummary
from engine.sweep.verdict.comparison import Comparison

_NODES = 12
_FAILING = 20
_PAIRS = 6


def markdown(summary: SweepSummary, comparison: Comparison | None = None) -> str:
    """Return the report."""
    return "\n".join(_lines(summary, comparison)) + "\n"


def _lines(summary: SweepSummary, comparison: Comparison | None) -> Iterator[str]:
    document = summary.sweep.document
    verdict = verdict_text(summary)
    yield f"# Sweep of {document.behavior}"
    yield ""
    if verdict:
        yield f"**{verdict}**"
        yield ""
    yield f"{rate_text(summary).capitalize()}. {end_text(summary).capitalize()}; {summary.cpu_s:.1f} s of CPU."
    if document.design != "random":
        yield ""
        yield "The configurations are not drawn at random: the share is that of this design, and has no interval."
    yield from markdown_section("Required", REQUIRED_HEAD, required_rows(summary))
    if comparison is not None:
        yield ""
        yield f"The success rate is {difference_text(comparison)}. Changed: {', '.join(comparison.changed)}."
    yield from markdown_section(
        "Outcomes",
        ("outcome", "runs", "share", "interval"),
        [
            (each.label, each.runs, percent(each.runs / summary.done), interval_text(each.interval))
            for each in summary.outcomes
        ],
    )
    yield from markdown_section(
        "Causes of failures",
        ("runs", "where", "cause", "for example"),
        [(each.runs, each.at, each.message, ", ".join(f"#{n}" for n in each.examples)) for each in summary.causes],
    )
    yield from _failing(summary)
    yield from markdown_section(
        "Factors, those that matter most first",
        ("factor", "correlation with success", "with duration", "success by level"),
        [_effect(each) for each in summary.effects],
    )
    durations = [summary.duration_s] if summary.duration_s is not None else []
    yield from markdown_section(
        "Seconds",
        ("node", "runs", "least", "middle", "95 %", "most"),
        [_quantiles(each, "s") for each in (*durations, *summary.nodes[:_NODES])],
    )
    yield from markdown_section(
        "Outputs",
        ("userdata", "runs", "least", "middle", "95 %", "most"),
        [_quantiles(each, "") for each in summary.outputs],
    )
    yield from markdown_section(
        "Measures",
        ("measure", "runs", "number", "least", "middle", "95 %", "most"),
        [
            (each.name, kind, *_quantiles(found, "")[1:])
            for each in summary.measures
            if each.least < each.most
            for kind, found in (("succeeded", each.successes), ("failed", each.failures))
            if found is not None
        ],
    )
    same = [f"{each.name} {value_text(each.least)}" for each in summary.measures if each.least == each.most]
    if same:
        yield ""
        yield f"The same in all runs: {', '.join(same)}."
    yield from markdown_section(
        "Inputs covered", ("factor", "parts with a run", "likeliest gap"), map(_input, summary.inputs.factors)
    )
    yield from markdown_section(
        f"Pairs of inputs covered least, of {len(summary.inputs.pairs)}",
        ("factor", "with", "pairs of parts with a run"),
        [
            (each.first, each.second, f"{each.covered} of {each.parts}")
            for each in summary.inputs.pairs[:_PAIRS]
            if each.covered < each.parts
        ],
    )
    yield ""
    covered = summary.items - len(summary.missing)
    yield f"Coverage of the behavior: {covered} of {summary.items} nodes and exits."
    yield f"Versions {summary.subject[:12]}."


def _failing(summary: SweepSummary) -> Iterator[str]:
    failing = summary.failing
    addresses = [address for address in (failing[0].configuration.values if failing else ()) if address != "seed"]
    yield from markdown_section(
        f"Failing runs, the first {_FAILING} of {len(failing)}" if len(failing) > _FAILING else "Failing runs",
        ("run", "seed", *addresses, "ended", "cause"),
        [
            (
                f"#{each.configuration.number}",
                each.configuration.seed,
                *(value_text(each.configuration.values[address]) for address in addresses),
                each.label,
                each.reason,
            )
            for each in failing[:_FAILING]
        ],
    )


def _effect(effect: FactorEffect) -> tuple[object, ...]:
    levels = "; ".join(f"{each.label}: {each.successes}/{each.runs}" for each in effect.levels)
    return effect.address, _correlation(effect.with_success), _correlation(effect.with_duration), levels


def _input(each: FactorCoverage) -> tuple[object, ...]:
    return each.address, f"{each.covered} of {each.parts}", gap_text(each)


def _correlation(value: float | None) -> str:
    return f"{value:+.2f}" if value is not None else "–"


def _quantiles(each: Quantiles, unit: str) -> tuple[object, ...]:
    numbers = (each.least, each.middle, each.p95, each.most)
    return (each.name, each.runs, *(f"{number:.3f}" if unit else f"{number:.4g}" for number in numbers))

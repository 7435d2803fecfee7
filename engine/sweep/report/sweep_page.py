"""A sweep as one self-contained HTML page with figures."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

from engine.sweep.report.figures import convergence, histogram, level_rates, scatter
from engine.sweep.report.tables import html_document, html_table
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
from engine.sweep.summary import Quantiles, SweepSummary
from engine.sweep.verdict.comparison import Comparison

_NODES = 25
_FAILING = 200
_FIGURES = 8
_PAIRS = 15


def html_page(summary: SweepSummary, comparison: Comparison | None = None) -> str:
    """Return the page; it loads nothing."""
    title = f"Sweep of {summary.sweep.document.behavior}"
    return html_document(title, _sections(summary, comparison, title))


def _sections(summary: SweepSummary, comparison: Comparison | None, title: str) -> Iterator[str]:
    document = summary.sweep.document
    yield f"<h1>{escape(title)}</h1>"
    if document.description:
        yield f"<p>{escape(document.description)}</p>"
    if summary.verdict is not None:
        yield f'<p class="verdict {summary.verdict}">{escape(verdict_text(summary))}</p>'
    yield f"<p>{escape(rate_text(summary).capitalize())}. {escape(end_text(summary).capitalize())}.</p>"
    yield from html_table("Required", REQUIRED_HEAD, required_rows(summary))
    if comparison is not None:
        changed = ", ".join(comparison.changed)
        yield f"<p>The success rate is {escape(difference_text(comparison))}. Changed: {escape(changed)}.</p>"
    ordered = summary.results[: summary.looked_at]
    if ordered and document.design == "random":
        figure = convergence(ordered, confidence=document.confidence, required=document.required_rate)
        yield f"<h2>Success rate after each run</h2><figure>{figure}</figure>"
    yield from html_table(
        "Causes of failures",
        ("runs", "where", "cause", "for example"),
        [(each.runs, each.at, each.message, ", ".join(f"#{n}" for n in each.examples)) for each in summary.causes],
    )
    yield from _failing(summary)
    yield from html_table(
        "Outcomes",
        ("outcome", "runs", "share", "interval"),
        [
            (each.label, each.runs, percent(each.runs / summary.done), interval_text(each.interval))
            for each in summary.outcomes
        ],
    )
    yield from _factors(summary)
    durations = [summary.duration_s] if summary.duration_s is not None else []
    head = ("runs", "least", "middle", "95 %", "most")
    yield from html_table("Seconds by node", ("node", *head), map(_quantiles, (*durations, *summary.nodes[:_NODES])))
    yield from html_table("Outputs", ("userdata", *head), map(_quantiles, summary.outputs))
    yield from _measures(summary)
    yield from _inputs(summary)
    covered = summary.items - len(summary.missing)
    yield f"<h2>Coverage</h2><p>{covered} of {summary.items} nodes and exits of the behavior were executed.</p>"
    yield from html_table(
        "Never executed",
        ("place", "node", "exit"),
        [(item.place, item.path, item.label) for item in summary.missing],
    )
    yield from html_table(
        "Versions", ("of", "version"), [(name, text[:16]) for name, text in summary.versions.items() if text]
    )


def _failing(summary: SweepSummary) -> Iterator[str]:
    failing = summary.failing[:_FAILING]
    addresses = [address for address in (failing[0].configuration.values if failing else ()) if address != "seed"]
    yield from html_table(
        "Failing runs",
        ("run", "seed", *addresses, "ended", "cause"),
        [
            (
                f"#{each.configuration.number}",
                each.configuration.seed,
                *(value_text(each.configuration.values[address]) for address in addresses),
                each.label,
                each.reason,
            )
            for each in failing
        ],
    )


def _factors(summary: SweepSummary) -> Iterator[str]:
    if not summary.effects or summary.done == 0:
        return
    yield "<h2>Factors, those that matter most first</h2>"
    rate = sum(each.success for each in summary.results) / summary.done
    for effect in summary.effects[:_FIGURES]:
        words = [
            f"rank correlation with {name} {value:+.2f}"
            for name, value in (("success", effect.with_success), ("duration", effect.with_duration))
            if value is not None
        ]
        caption = f"<code>{escape(effect.address)}</code>: {escape('; '.join(words))}"
        yield f"<figure><figcaption>{caption}</figcaption>{level_rates(effect, rate=rate)}</figure>"
    numbers = [
        each.address for each in summary.effects if each.with_duration is not None or each.with_success is not None
    ]
    if len(numbers) > 1:
        first, second = numbers[:2]
        figure = scatter(summary.results, first, second)
        yield f"<figure><figcaption>Runs over the first two</figcaption>{figure}</figure>"


def _measures(summary: SweepSummary) -> Iterator[str]:
    yield from html_table(
        "Measures",
        ("measure", "runs", "number", "least", "middle", "95 %", "most"),
        [
            (each.name, kind, *_quantiles(found)[1:])
            for each in summary.measures
            for kind, found in (("succeeded", each.successes), ("failed", each.failures))
            if found is not None
        ],
    )
    for each in summary.measures:
        if each.least < each.most:
            caption = f"<figcaption><code>{escape(each.name)}</code></figcaption>"
            yield f"<figure>{caption}{histogram(summary.results, each)}</figure>"


def _inputs(summary: SweepSummary) -> Iterator[str]:
    inputs = summary.inputs
    yield from html_table(
        "Inputs covered",
        ("factor", "parts with a run", "likeliest gap"),
        [(each.address, f"{each.covered} of {each.parts}", gap_text(each)) for each in inputs.factors],
    )
    yield from html_table(
        "Pairs of inputs, those covered least first",
        ("factor", "with", "pairs of parts with a run"),
        [(each.first, each.second, f"{each.covered} of {each.parts}") for each in inputs.pairs[:_PAIRS]],
    )


def _quantiles(each: Quantiles) -> tuple[object, ...]:
    return (each.name, each.runs, *(f"{number:.4g}" for number in (each.least, each.middle, each.p95, each.most)))

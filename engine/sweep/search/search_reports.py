"""Reports of searches: Markdown, one HTML page with figures, JSON and CSV; they never show a success rate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path

import msgspec

from engine.errors import FlexcellError
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.report import SUFFIXES, csv_table
from engine.sweep.report.figures import scatter
from engine.sweep.report.result_rows import rows
from engine.sweep.report.tables import html_document, html_table, markdown_section
from engine.sweep.report.words import interval_text, percent, value_text
from engine.sweep.search.search_figures import margin_trace
from engine.sweep.search.search_summary import FactorRegion, FailureCluster, SearchSummary

_FAILING = 20
_REGION_HEAD = ("factor", "failing", "executed", "likelihood of that", "successes in there")
_BATCH_HEAD = ("batch", "runs", "failures", "refused", "nearest")
Table = tuple[str, tuple[str, ...], list[tuple[object, ...]]]


def search_report(summary: SearchSummary, file: Path) -> bytes:
    """Return the report that the suffix of a file asks for.

    Raises:
        FlexcellError: there is no such report.
    """
    match file.suffix:
        case ".md":
            return search_markdown(summary).encode()
        case ".html":
            return _page(summary).encode()
        case ".json":
            return _json(summary)
        case ".csv":
            return csv_table(summary.results).encode()
        case _:
            raise FlexcellError(f"there is no report `{file.suffix}`", where=file, hint=", ".join(SUFFIXES))


def search_markdown(summary: SearchSummary) -> str:
    """Return the report for a terminal or a pull request."""
    return "\n".join(_lines(summary)) + "\n"


def found_text(summary: SearchSummary) -> str:
    """Return how many failures were found in how many runs, and why the search ended, in one or two sentences."""
    done, planned, failing = len(summary.steps), summary.spec.runs, len(summary.failing)
    text = f"{failing} of {done} runs failed" if failing else f"No failure in {done} runs"
    if summary.refused:
        text += f", {summary.refused} were refused"
    if failing:
        text += f"; the first one is run #{summary.failing[0].configuration.number}"
    match summary.ended_by:
        case "failures":
            return f"{text}. The search ended with {'its first failure' if failing == 1 else f'{failing} failures'}."
        case "time":
            return f"{text}. Its time is over, {planned - done} runs are left."
        case "interrupted":
            return f"{text}. Interrupted, {planned - done} runs are left."
        case "runs":
            return f"{text}."


def method_text(summary: SearchSummary) -> str:
    """Return by which method the search went towards what, in one sentence."""
    name = "cross-entropy" if summary.spec.method == "cross_entropy" else "optuna"
    towards = f"{summary.target.text} of runs that succeed" if summary.target.guides else "failures alone"
    return f"Searched by {name} towards {towards}, in {len(summary.batches)} batches."


def probability_text(summary: SearchSummary) -> str:
    """Return what the search says about how likely failures are, in one or two sentences."""
    found = summary.probability
    if found is None:
        return (
            "The runs were chosen to fail: they give no success rate and no interval of it, and this method does not "
            "tell how likely its choices are. A random design gives both."
        )
    confidence = percent(summary.sweep.document.confidence)
    return (
        "The runs were chosen to fail: their share of failures is no rate. Weighted by how likely the written "
        f"distributions draw them, {percent(found.estimate)} of all runs fail; {interval_text(found.interval)} with "
        f"{confidence} confidence at any time ({found.effective_failures:.1f} effective failures)."
    )


def _lines(summary: SearchSummary) -> Iterator[str]:
    yield f"# Failure search in {summary.sweep.document.behavior}"
    yield ""
    yield f"{found_text(summary)} {method_text(summary)}"
    yield ""
    yield probability_text(summary)
    for cluster in summary.clusters:
        yield from markdown_section(_cause(cluster), _REGION_HEAD, map(_region, cluster.regions))
    for title, head, found in _tables(summary):
        yield from markdown_section(title, head, found)
    if summary.failing:
        number = summary.failing[0].configuration.number
        yield ""
        yield f"The smallest change that still fails: `flexcell sweep shrink FILE {number}`."
    yield ""
    yield f"Versions {summary.subject[:12]}; {summary.cpu_s:.1f} s of CPU."


def _page(summary: SearchSummary) -> str:
    title = f"Failure search in {summary.sweep.document.behavior}"
    return html_document(title, _sections(summary, title))


def _sections(summary: SearchSummary, title: str) -> Iterator[str]:
    yield f"<h1>{escape(title)}</h1>"
    if summary.sweep.document.description:
        yield f"<p>{escape(summary.sweep.document.description)}</p>"
    yield f"<p>{escape(found_text(summary))} {escape(method_text(summary))}</p>"
    yield f"<p>{escape(probability_text(summary))}</p>"
    if summary.steps:
        yield f"<h2>How near to failure</h2><figure>{margin_trace(summary)}</figure>"
    for cluster in summary.clusters:
        yield from html_table(_cause(cluster), _REGION_HEAD, map(_region, cluster.regions))
        numbers = [
            each.address for each in cluster.regions if summary.sweep.document.factors[each.address].values is None
        ]
        if len(numbers) > 1:
            yield f"<figure>{scatter(summary.results, numbers[0], numbers[1])}</figure>"
    for name, head, found in _tables(summary):
        yield from html_table(name, head, found)
    yield from html_table(
        "Versions", ("of", "version"), [(name, text[:16]) for name, text in summary.versions.items() if text]
    )


def _tables(summary: SearchSummary) -> Iterator[Table]:
    addresses = [address for address in summary.sweep.document.factors if address != "seed"]
    failing = summary.failing
    rare = [cluster.cause for cluster in summary.clusters if not cluster.regions]
    yield (
        "Causes of one or two runs",
        ("runs", "where", "cause", "for example"),
        [(each.runs, each.at, each.message, ", ".join(f"#{number}" for number in each.examples)) for each in rare],
    )
    yield (
        f"Failing runs, the first {_FAILING} of {len(failing)}" if len(failing) > _FAILING else "Failing runs",
        ("run", "seed", *addresses, "ended", "cause"),
        [(*_row(each, addresses), each.label, each.reason) for each in failing[:_FAILING]],
    )
    yield (
        "Nearest successes" if summary.target.guides else "Successes that took longest",
        ("run", "seed", *addresses, summary.target.text),
        [(*_row(each, addresses), value_text(summary.target.value(each))) for each in summary.nearest],
    )
    yield (
        "Batches",
        (*_BATCH_HEAD[:-1], summary.target.text),
        [(each.batch, each.runs, each.failures, each.refused, _nearest(each.nearest)) for each in summary.batches],
    )


def _row(result: TrialResult, addresses: list[str]) -> tuple[object, ...]:
    configuration = result.configuration
    values = (value_text(configuration.values[address]) for address in addresses)
    return f"#{configuration.number}", configuration.seed, *values


def _cause(cluster: FailureCluster) -> str:
    cause = cluster.cause
    at = f"{cause.at}: " if cause.at else ""
    return f"{at}{cause.message} ({cause.runs} runs, for example #{cause.examples[0]})"


def _region(region: FactorRegion) -> tuple[object, ...]:
    return (
        region.address,
        _range(region.failing, listed=region.listed),
        _range(region.executed, listed=region.listed),
        percent(region.share),
        region.passed_inside,
    )


def _range(values: Sequence[object], *, listed: bool) -> str:
    return (", " if listed else " to ").join(map(value_text, values))


def _nearest(value: float | None) -> str:
    return "–" if value is None else value_text(value)


def _json(summary: SearchSummary) -> bytes:
    found = summary.probability
    document: dict[str, object] = {
        "behavior": summary.sweep.document.behavior,
        "subject": summary.subject,
        "versions": summary.versions,
        "search": summary.spec,
        "towards": summary.target.text,
        "ended_by": summary.ended_by,
        "planned": summary.spec.runs,
        "done": len(summary.steps),
        "failures": len(summary.failing),
        "refused": summary.refused,
        "probability": found,
        "clusters": summary.clusters,
        "nearest": [each.configuration.number for each in summary.nearest],
        "batches": summary.batches,
        "cpu_s": summary.cpu_s,
        "results": [
            {**row, "batch": step.point.batch, "weight": step.point.weight}
            for row, step in zip(rows(summary.results), summary.steps, strict=True)
        ],
    }
    return msgspec.json.format(msgspec.json.encode(document), indent=1)

"""What a user interface shows of a search for failures, in the words and with the figure of its report."""

from __future__ import annotations

from dataclasses import fields
from typing import get_type_hints

import msgspec

from engine.document.sweep import SweepDocument
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.search.search_execution import SearchEnd, SearchProgress
from engine.sweep.search.search_figures import margin_trace
from engine.sweep.search.search_reports import found_text, method_text, probability_text
from engine.sweep.search.search_summary import SearchSummary, summarize_search
from engine.sweep.search.target import SearchTarget
from engine.sweep_library.sweep_view import SearchLive, SweepLine, SweepLive

_APART = frozenset({"sweep", "steps", "failing"})
"""What is of_head otherwise: the document as it is, its runs by `SweepRuns`."""


class SearchHead(msgspec.Struct, frozen=True, kw_only=True):
    """A search with what it has found in sentences, and how near to failure each run was as SVG."""

    line: SweepLine
    document: SweepDocument
    done: int
    failures: int
    towards: str
    """The number that is searched for, as it is written."""
    found: str
    method: str
    likelihood: str
    figure: str
    """Each mark has the number of its run as `data-run`."""


_HINTS = get_type_hints(SearchSummary)
_FIGURES = tuple(each.name for each in fields(SearchSummary) if each.name not in _APART)
SearchView = msgspec.defstruct(
    "SearchView", [(name, _HINTS[name]) for name in _FIGURES], bases=(SearchHead,), frozen=True, kw_only=True
)
"""A search with everything that its summary tells, under the same names."""


def search_view_of(line: SweepLine, end: SearchEnd) -> msgspec.Struct:
    """Return a `SearchView`."""
    summary = summarize_search(end)
    figures = {name: getattr(summary, name) for name in _FIGURES}
    figures["nearest"] = [msgspec.structs.replace(each, nodes={}, covered="") for each in summary.nearest]
    return SearchView(
        line=line,
        document=summary.sweep.document,
        done=len(summary.steps),
        failures=len(summary.failing),
        towards=summary.target.text,
        found=found_text(summary),
        method=method_text(summary),
        likelihood=probability_text(summary),
        figure=margin_trace(summary),
        **figures,
    )


def search_live_of(end: SearchEnd) -> SweepLive:
    """Return how far a search is that is not being executed."""
    summary = summarize_search(end)
    nearest = summary.nearest[0] if summary.nearest else None
    return SweepLive(
        planned=end.spec.runs,
        done=len(end.steps),
        search=SearchLive(
            failures=len(summary.failing),
            nearest=_number(end.target, nearest),
            is_satisfied=end.ended_by == "failures",
        ),
    )


def searching(progress: SearchProgress) -> SweepLive:
    """Return how far a search is that is being executed."""
    rate_hz = progress.executed / progress.elapsed_s if progress.elapsed_s > 0.0 else 0.0
    return SweepLive(
        status="running",
        planned=progress.planned,
        done=progress.done,
        rate_hz=rate_hz,
        remaining_s=(progress.planned - progress.done) / rate_hz if rate_hz > 0.0 else None,
        search=SearchLive(failures=progress.failures, nearest=_number(progress.target, progress.nearest)),
    )


def _number(target: SearchTarget, nearest: TrialResult | None) -> float | None:
    return target.value(nearest) if nearest is not None and target.guides else None

"""What a failure search of `flexcell sweep` writes: progress, JUnit, and the summary of a GitHub job."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

from engine.cli.output.junit import JunitCase, JunitProblem, JunitSuite, class_name, write_junit
from engine.cli.output.sweep_output import append_github_summary
from engine.sweep.report.words import value_text
from engine.sweep.search import SearchProgress, SearchSummary, search_markdown
from engine.sweep.search.search_reports import found_text

_EVERY_S = 10.0
_MINUTE_S = 60.0


class SearchPrinter:
    """Prints the progress of a search on stderr: a line at the end of each batch, after a failure, or after 10 s.

    Args:
        quiet: Whether nothing is printed.
    """

    def __init__(self, *, quiet: bool) -> None:
        self._quiet = quiet
        self._printed = (-1, -1)
        self._printed_s = 0.0

    def show(self, progress: SearchProgress) -> None:
        """Print how far the search is, where it has something new."""
        state = (progress.batch, progress.failures)
        ended = progress.done == progress.planned
        if self._quiet or (state == self._printed and not ended and progress.elapsed_s < self._printed_s + _EVERY_S):
            return
        self._printed, self._printed_s = state, progress.elapsed_s
        sys.stderr.write(search_progress_text(progress) + "\n")
        sys.stderr.flush()


def search_progress_text(progress: SearchProgress) -> str:
    """Return the batch, the runs, the failures, the nearest success and the speed."""
    parts = [f"{progress.done} of {progress.planned}: batch {progress.batch}, {progress.failures} failures"]
    if progress.nearest is not None and (value := progress.target.value(progress.nearest)) is not None:
        parts.append(f"{progress.target.text} {value_text(value)} (#{progress.nearest.configuration.number})")
    if progress.executed:
        parts.append(f"{_MINUTE_S * progress.executed / max(progress.elapsed_s, 1e-9):.1f} runs/min")
    return ", ".join(parts)


def write_search_junit(path: Path, file: Path, summary: SearchSummary) -> None:
    """Write a search as JUnit: one case, which passes where no failure was found.

    Raises:
        FlexcellError: the file cannot be written.
    """
    problem = None
    if summary.failing:
        text = search_markdown(summary)
        problem = JunitProblem(kind="failure", type="failed", message=found_text(summary), text=text)
    case = JunitCase(name="no failure found", classname=class_name(file), time_s=summary.cpu_s, problem=problem)
    properties = {"subject": summary.subject, "runs": str(len(summary.steps)), "failures": str(len(summary.failing))}
    suite = JunitSuite(name=f"failure search {file.name}", file=str(file), cases=[case], properties=properties)
    write_junit(path, [suite])


def write_search_github_summary(summary: SearchSummary, environment: Mapping[str, str]) -> None:
    """In a GitHub job, append the report to its summary, and annotate it where a failure was found.

    Raises:
        FlexcellError: the file of the summary cannot be written.
    """
    if append_github_summary(search_markdown(summary), environment) and summary.failing:
        sys.stderr.write(f"::error title=failure found::{found_text(summary)}\n")

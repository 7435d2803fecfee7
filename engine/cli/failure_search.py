"""What `flexcell sweep` does otherwise where a sweep is a search: what it refuses, reports and returns."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path

from engine.cli.exit_code import ExitCode
from engine.cli.output.output_file import write
from engine.cli.output.search_output import write_search_github_summary, write_search_junit
from engine.errors import FlexcellError
from engine.sweep.search import SearchSummary, search_markdown, search_report


def require_no_search(*, shard: str | None, baseline: Path | None) -> None:
    """Refuse what a search cannot do.

    Raises:
        FlexcellError: a part of it is wanted, or a comparison.
    """
    if shard is not None:
        raise FlexcellError(
            "a search has no parts: which runs come next depends on the results of all runs before",
            where="--shard",
            hint="more --workers, or --search none for the design",
        )
    if baseline is not None:
        raise FlexcellError(
            "two versions are searched differently: their runs cannot be compared",
            where="--baseline",
            hint="--search none compares the design",
        )


def report_search(summary: SearchSummary, file: Path, files: Sequence[Path], junit: Path | None, *, json: bool) -> None:
    """Write the reports of a search, and one to stdout.

    Raises:
        FlexcellError: a file cannot be written.
    """
    for each in files:
        write(each, search_report(summary, each))
    if junit is not None:
        write_search_junit(junit, file, summary)
    write_search_github_summary(summary, os.environ)
    text = search_report(summary, Path("report.json")).decode() + "\n" if json else search_markdown(summary)
    sys.stdout.write(text)


def search_exit_code(summary: SearchSummary) -> ExitCode:
    """Return the exit code: a search succeeds where it finds no failure."""
    if summary.failing:
        return ExitCode.OTHER_OUTCOME
    return ExitCode.INTERRUPTED if summary.ended_by == "interrupted" else ExitCode.SUCCESS

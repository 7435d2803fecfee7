"""Reports of sweeps: Markdown for people and pull requests, one HTML page with figures, and tables for programs."""

from __future__ import annotations

from pathlib import Path

from engine.errors import FlexcellError
from engine.sweep.report.markdown import markdown
from engine.sweep.report.parquet_table import parquet_table
from engine.sweep.report.result_rows import csv_table, json_report
from engine.sweep.report.sweep_page import html_page
from engine.sweep.summary import SweepSummary
from engine.sweep.verdict.comparison import Comparison

SUFFIXES = (".md", ".html", ".json", ".csv", ".parquet")


def report(summary: SweepSummary, comparison: Comparison | None, file: Path) -> bytes:
    """Return the report that the suffix of a file asks for.

    Raises:
        FlexcellError: there is no such report, or what it needs is not installed.
    """
    match file.suffix:
        case ".md":
            return markdown(summary, comparison).encode()
        case ".html":
            return html_page(summary, comparison).encode()
        case ".json":
            return json_report(summary, comparison)
        case ".csv":
            return csv_table(summary.results).encode()
        case ".parquet":
            return parquet_table(summary.results)
        case _:
            raise FlexcellError(f"there is no report `{file.suffix}`", where=file, hint=", ".join(SUFFIXES))


__all__ = ["SUFFIXES", "csv_table", "html_page", "json_report", "markdown", "parquet_table", "report"]

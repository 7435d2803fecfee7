"""Formats the coverage of behaviors for people, CI servers and editors."""

from __future__ import annotations

from importlib.metadata import version
from typing import Literal

import msgspec

from engine.coverage.cobertura import cobertura_report
from engine.coverage.coverage_file import BehaviorCoverage, CoverageFile
from engine.coverage.html_page import html_page
from engine.coverage.lcov import lcov_report
from engine.coverage.text_table import text_report

ReportFormat = Literal["text", "html", "cobertura", "lcov", "json"]


def report(coverages: tuple[BehaviorCoverage, ...], form: ReportFormat, *, time_s: float) -> str:
    """Return the report; `time_s` is the report time in Unix time."""
    match form:
        case "text":
            return text_report(coverages)
        case "html":
            return html_page(coverages)
        case "cobertura":
            return cobertura_report(coverages, version=f"flexcell {version('flexcell')}", time_s=time_s)
        case "lcov":
            return lcov_report(coverages)
        case "json":
            return msgspec.json.format(msgspec.json.encode(CoverageFile(behaviors=coverages)), indent=1).decode() + "\n"

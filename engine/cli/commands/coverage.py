"""`flexcell coverage`: reports coverage of behaviors, and collects it from the logs of runs."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_behavior
from engine.cli.output.output_file import prepare, write
from engine.coverage import CoverageCollector, merge, read_coverage
from engine.coverage.coverage_file import BehaviorCoverage, percent
from engine.coverage.event_logs import RunEventLog, read_logs
from engine.coverage.report import report as write_report
from engine.errors import FlexcellError
from engine.registry import load_states

app = typer.Typer(help="Report which parts of behaviors were executed by runs.", no_args_is_help=True)


@app.command("report")
def report(
    files: Annotated[
        list[Path], typer.Argument(help="Coverage files of `flexcell run --coverage`.", show_default=False)
    ],
    format_: Annotated[
        Literal["text", "html", "cobertura", "lcov", "json"],
        typer.Option("--format", help="Output format: html is one page; cobertura and lcov are for CI servers."),
    ] = "text",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write the report to this file instead of stdout.")
    ] = None,
    fail_under: Annotated[
        float | None, typer.Option(help="Exit code 1 if the coverage is below this percentage.", min=0, max=100)
    ] = None,
) -> None:
    """Report the coverage of any number of runs, merged per behavior.

    Counts nodes that were entered, and exits of nodes that were taken: transitions, outcomes,
    conditions, timeouts, guards, error targets, statuses.
    """
    prepare(output)
    coverages = merge(tuple(coverage for file in files for coverage in read_coverage(file)))
    if not coverages:
        raise FlexcellError("these files contain no coverage", hint="write coverage with `flexcell run --coverage`")
    text = write_report(coverages, format_, time_s=time.time())
    if output is None:
        sys.stdout.write(text)
    else:
        write(output, text.encode())
    _require_coverage(coverages, fail_under)


@app.command("collect")
def collect(
    behavior: Annotated[Path, typer.Argument(help="Behavior that the runs executed.", show_default=False)],
    logs: Annotated[
        list[Path],
        typer.Argument(help="Journal folders, recordings (.mcap) or event logs (.jsonl).", show_default=False),
    ],
    to: Annotated[Path, typer.Option(help="Coverage file to add to; it is created if missing.")] = Path(
        "coverage.json"
    ),
) -> None:
    """Collect the coverage of earlier runs of a behavior from journals, recordings or event logs.

    In a journal, runs of other behaviors and of other versions of this one are skipped; as
    separate files they are an error.
    """
    catalogue = load_states(behavior)
    document, _ = read_behavior(behavior, catalogue)
    coverage = CoverageCollector(document, catalogue)
    coverage.require_same(to)
    skipped = 0
    for log in logs:
        runs = read_logs(log)
        is_journal = log.is_dir() or log.suffix == ".db"
        matching = [run for run in runs if run.document == document.meaning or not is_journal]
        skipped += len(runs) - len(matching)
        for run in matching:
            _add(coverage, run)
    coverage.accumulate(to)
    others = f", {skipped} of other documents skipped" if skipped else ""
    sys.stderr.write(f"{coverage.runs} runs added to {to}{others}: {coverage.percent:.1f} % covered by them\n")


def _add(coverage: CoverageCollector, run: RunEventLog) -> None:
    try:
        coverage.add(run.events)
    except FlexcellError as error:
        raise FlexcellError(error.message, where=run.name, hint=error.hint) from error


def _require_coverage(coverages: tuple[BehaviorCoverage, ...], fail_under: float | None) -> None:
    share = percent(sum(c.covered for c in coverages), sum(len(c.items) for c in coverages))
    if fail_under is not None and share < fail_under:
        sys.stderr.write(f"flexcell: coverage {share:.1f} % is below the required {fail_under:g} %\n")
        raise typer.Exit(ExitCode.OTHER_OUTCOME)

"""`flexcell coverage`: what runs have covered of their behaviors, as reports and from event logs."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_behavior
from engine.cli.output_file import prepare, write
from engine.coverage import CoverageCollector, merge, read_coverage
from engine.coverage.coverage_file import BehaviorCoverage, percent
from engine.coverage.event_logs import RunEventLog, read_logs
from engine.coverage.report import report as write_report
from engine.errors import FlexcellError
from engine.registry import load_states

app = typer.Typer(help="Tell what runs have covered of their behaviors.", no_args_is_help=True)


@app.command("report")
def report(
    files: Annotated[
        list[Path], typer.Argument(help="Files that `flexcell run --coverage` wrote.", show_default=False)
    ],
    format_: Annotated[
        Literal["text", "html", "cobertura", "lcov", "json"],
        typer.Option("--format", help="How it is written: html is one page, cobertura and lcov are for CI servers."),
    ] = "text",
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write it here instead of on stdout.")] = None,
    fail_under: Annotated[
        float | None, typer.Option(help="Exit code 1 when less than this many percent are covered.", min=0, max=100)
    ] = None,
) -> None:
    """Report the coverage of any number of runs, added up by behavior.

    Covered are nodes that were entered, and ways out of them that were taken: transitions,
    outcomes, conditions, timeouts, guards, error targets, statuses.
    """
    prepare(output)
    coverages = merge(tuple(coverage for file in files for coverage in read_coverage(file)))
    if not coverages:
        raise FlexcellError("there is no coverage in these files", hint="fill them with `flexcell run --coverage`")
    text = write_report(coverages, format_, time_s=time.time())
    if output is None:
        sys.stdout.write(text)
    else:
        write(output, text.encode())
    _judge(coverages, fail_under)


@app.command("collect")
def collect(
    behavior: Annotated[Path, typer.Argument(help="The behavior that was run.", show_default=False)],
    logs: Annotated[
        list[Path],
        typer.Argument(help="Journal directories, recordings (.mcap) or event logs (.jsonl).", show_default=False),
    ],
    to: Annotated[Path, typer.Option(help="Add it to this file; it is made at first.")] = Path("coverage.json"),
) -> None:
    """Count what earlier runs of a behavior have covered, from what was kept of them.

    Runs of other behaviors, and of other versions of this one, are left out of a journal; as a
    file of their own they are refused.
    """
    catalogue = load_states(behavior)
    found, _ = read_behavior(behavior, catalogue)
    coverage = CoverageCollector(found, catalogue)
    coverage.require_same(to)
    left_out = 0
    for place in logs:
        runs = read_logs(place)
        many = place.is_dir() or place.suffix == ".db"
        of_this = [run for run in runs if run.document == found.meaning or not many]
        left_out += len(runs) - len(of_this)
        for run in of_this:
            _add(coverage, run)
    coverage.accumulate(to)
    others = f", {left_out} of other documents left out" if left_out else ""
    sys.stderr.write(f"{coverage.runs} runs added to {to}{others}: {coverage.percent:.1f} % covered by them\n")


def _add(coverage: CoverageCollector, run: RunEventLog) -> None:
    try:
        coverage.add(run.events)
    except FlexcellError as error:
        raise FlexcellError(error.message, where=run.name, hint=error.hint) from error


def _judge(coverages: tuple[BehaviorCoverage, ...], fail_under: float | None) -> None:
    share = percent(sum(c.covered for c in coverages), sum(len(c.items) for c in coverages))
    if fail_under is not None and share < fail_under:
        sys.stderr.write(f"flexcell: {share:.1f} % is covered, {fail_under:g} % is asked for\n")
        raise typer.Exit(ExitCode.OTHER_OUTCOME)

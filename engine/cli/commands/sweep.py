"""`flexcell sweep`: how often a behavior succeeds, how it fails, and the smallest case that shows it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from engine.cli.commands.sweep_trial import rerun, shrink
from engine.cli.exit_code import ExitCode
from engine.cli.failure_search import report_search, require_no_search, search_exit_code
from engine.cli.output.output_file import prepare, write
from engine.cli.output.search_output import SearchPrinter
from engine.cli.output.sweep_output import SweepPrinter, write_github_summary, write_sweep_junit
from engine.cli.sweep_arguments import (
    Cell,
    Design,
    File,
    Method,
    Parameter,
    Results,
    Runs,
    Search,
    Seed,
    Simulate,
    Vary,
)
from engine.cli.sweep_choice import existing_results
from engine.cli.sweep_execution_options import ClusterAddress, execution_options
from engine.cli.sweep_options import SweepOverrides, read_sweep
from engine.document.duration import seconds
from engine.errors import FlexcellError
from engine.sweep import (
    Comparison,
    Shard,
    SweepEnd,
    SweepResults,
    SweepSubject,
    SweepSummary,
    compare_with_baseline,
    configurations,
    execute_sweep,
    saved_sweep,
    summarize,
)
from engine.sweep.execution.trial_execution import DEFAULT_MEMORY_BYTES, ProcessLimits
from engine.sweep.report import markdown, report
from engine.sweep.search import execute_search, saved_search, summarize_search
from engine.sweep.sweep_table import DEFAULT_RESULTS
from engine.sweep.verdict.judged_requirement import require_known_numbers

_MEBIBYTE = 2**20
_DEFAULT = "run"


class _RunByDefault(TyperGroup):
    """`flexcell sweep FILE` is `flexcell sweep run FILE`."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        named = next((each for each in args if not each.startswith("-")), None)
        if named is not None and named not in self.commands:
            args = [_DEFAULT, *args]
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=_RunByDefault,
    help="Execute a behavior many times with varied factors: how often it succeeds, and how it fails.",
    no_args_is_help=True,
)

Require = Annotated[
    list[str] | None,
    typer.Option(
        help='What is required, may be repeated: "success >= 0.98", or the share of runs in which a number keeps a '
        'limit, "share(cell.contact_force_max_n <= 30) >= 0.95".'
    ),
]
Width = Annotated[
    float | None, typer.Option(help="End when the interval of the success rate is at most so wide.", min=0.0, max=1.0)
]
Confidence = Annotated[float | None, typer.Option(help="Confidence of intervals.", min=0.5, max=0.9999)]
StopAfter = Annotated[int | None, typer.Option(help="With --search: failures after which it ends.", min=1)]
Baseline = Annotated[
    Path | None, typer.Option(help="Compare with another version that has executed this sweep into this file.")
]
Margin = Annotated[
    float | None,
    typer.Option(help="With --baseline: how much lower the success rate may be, for example 0.02.", min=0.0, max=1.0),
]
Junit = Annotated[Path | None, typer.Option(help="Write the verdict to this file as JUnit XML.")]
Json = Annotated[bool, typer.Option("--json", help="Print the report as one JSON object on stdout.")]


@app.command(_DEFAULT)
def run(
    file: File,
    vary: Vary = None,
    runs: Runs = None,
    time: Annotated[str | None, typer.Option(help="Wall time after which no run begins, for example `10 min`.")] = None,
    width: Width = None,
    require: Require = None,
    design: Design = None,
    search: Search = None,
    method: Method = None,
    seed: Seed = None,
    cell: Cell = None,
    simulate: Simulate = None,
    parameter: Parameter = None,
    stop_after: StopAfter = None,
    confidence: Confidence = None,
    results: Results = DEFAULT_RESULTS,
    workers: Annotated[
        int | None, typer.Option(help="Processes that execute runs; by default one for each processor.", min=1, max=256)
    ] = None,
    memory: Annotated[int, typer.Option(help="Memory for the data of one process in MiB.", min=256)] = (
        DEFAULT_MEMORY_BYTES // _MEBIBYTE
    ),
    scheduler: Annotated[
        str | None,
        typer.Option(help="Execute runs on the workers of this Dask cluster, tls://HOST:8786; needs the extra `dask`."),
    ] = None,
    tls_ca_file: Annotated[
        Path | None, typer.Option(help="With --scheduler: certificate of the authority of the cluster, PEM.")
    ] = None,
    tls_cert: Annotated[Path | None, typer.Option(help="With --scheduler: certificate of this client, PEM.")] = None,
    tls_key: Annotated[
        Path | None, typer.Option(help="With --scheduler: its private key, PEM, if it is not with the certificate.")
    ] = None,
    shard: Annotated[str | None, typer.Option(help="Execute only part I of N, I/N; `sweep merge` joins them.")] = None,
    again: Annotated[
        bool, typer.Option("--again", help="Execute configurations again whose process crashed or hung.")
    ] = False,
    baseline: Baseline = None,
    margin: Margin = None,
    report_: Annotated[
        list[Path] | None,
        typer.Option("--report", help="Write a report: FILE.md, .html, .json, .csv or .parquet; may be repeated."),
    ] = None,
    junit: Junit = None,
    json: Json = False,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Do not print progress.")] = False,
) -> None:
    """Execute the runs of a sweep that have no result yet, and report all its results.

    Exit code 0: what is required is reached, or nothing is. 1: it is not reached. 5: undecided. 2: something is wrong,
    mostly before anything was executed. 130: interrupted; what had ended is saved, and the same command goes on.
    """
    prepare(junit, *(report_ or ()))
    cluster = ClusterAddress(scheduler=scheduler, tls_ca_file=tls_ca_file, tls_cert=tls_cert, tls_key=tls_key)
    overrides = SweepOverrides(
        vary=tuple(vary or ()),
        runs=runs,
        time=time,
        width=width,
        require=tuple(require or ()),
        design=design,
        seed=seed,
        cell=cell,
        simulate=simulate or (),
        parameters=tuple(parameter or ()),
        confidence=confidence,
        search=search,
        method=method,
        stop_after=stop_after,
    )
    sweep = read_sweep(file, overrides)
    limits = ProcessLimits(timeout_s=seconds(sweep.document.timeout), memory_bytes=memory * _MEBIBYTE)
    options = execution_options(cluster, workers, limits)
    if sweep.document.search is not None:
        require_no_search(shard=shard, baseline=baseline)
        subject = SweepSubject.load(sweep)
        with SweepResults.open(results) as saved:
            show = SearchPrinter(quiet=quiet or json).show
            found = summarize_search(execute_search(subject, saved, options, again=again, show=show))
        report_search(found, file, report_ or (), junit, json=json)
        raise typer.Exit(search_exit_code(found))
    planned = configurations(sweep)
    subject = SweepSubject.load(sweep)
    printer = SweepPrinter(quiet=quiet or json)
    with SweepResults.open(results) as saved, printer:
        end = execute_sweep(subject, planned, saved, options, shard=_shard(shard), again=again, show=printer.show)
    summary, comparison = _compared(end, baseline, margin)
    _report(summary, comparison, file, report_ or (), junit, json=json)
    raise typer.Exit(_exit_code(summary, comparison))


@app.command("report")
def report_saved(
    file: File,
    vary: Vary = None,
    runs: Runs = None,
    require: Require = None,
    design: Design = None,
    search: Search = None,
    method: Method = None,
    seed: Seed = None,
    cell: Cell = None,
    simulate: Simulate = None,
    parameter: Parameter = None,
    stop_after: StopAfter = None,
    confidence: Confidence = None,
    results: Results = DEFAULT_RESULTS,
    baseline: Baseline = None,
    margin: Margin = None,
    output: Annotated[
        list[Path] | None,
        typer.Option("--report", help="Write a report: FILE.md, .html, .json, .csv or .parquet; may be repeated."),
    ] = None,
    junit: Junit = None,
    json: Json = False,
) -> None:
    """Report the saved results of a sweep, without executing anything; exit codes as those of `sweep run`."""
    prepare(junit, *(output or ()))
    overrides = SweepOverrides(
        vary=tuple(vary or ()),
        runs=runs,
        require=tuple(require or ()),
        design=design,
        seed=seed,
        cell=cell,
        simulate=simulate or (),
        parameters=tuple(parameter or ()),
        confidence=confidence,
        search=search,
        method=method,
        stop_after=stop_after,
    )
    sweep = read_sweep(file, overrides)
    if sweep.document.search is not None:
        require_no_search(shard=None, baseline=baseline)
        with existing_results(results) as saved:
            found = summarize_search(saved_search(SweepSubject.load(sweep), saved))
        report_search(found, file, output or (), junit, json=json)
        raise typer.Exit(search_exit_code(found))
    with existing_results(results) as saved:
        end = saved_sweep(SweepSubject.load(sweep), configurations(sweep), saved)
    summary, comparison = _compared(end, baseline, margin)
    _report(summary, comparison, file, output or (), junit, json=json)
    raise typer.Exit(_exit_code(summary, comparison))


@app.command("merge")
def merge(
    files: Annotated[list[Path], typer.Argument(help="Files of results, for example of shards.", show_default=False)],
    to: Annotated[Path, typer.Option(help="File to add to; it is created if missing.")] = DEFAULT_RESULTS,
) -> None:
    """Add the results of other files, each configuration once; equal configurations must have equal results."""
    with SweepResults.open(to) as merged:
        added = merged.merge(files)
    sys.stderr.write(f"{added} results added to {to}\n")


app.command("rerun")(rerun)
app.command("shrink")(shrink)


def _shard(text: str | None) -> Shard | None:
    if text is None:
        return None
    index, slash, count = text.partition("/")
    if not slash or not index.isdecimal() or not count.isdecimal() or not 1 <= int(index) <= int(count):
        raise FlexcellError(f"{text!r} is not a part of a sweep", where="--shard", hint="1/3, 2/3 or 3/3")
    return Shard(index=int(index) - 1, count=int(count))


def _compared(end: SweepEnd, baseline: Path | None, margin: float | None) -> tuple[SweepSummary, Comparison | None]:
    require_known_numbers(end.subject.sweep, end.results)
    summary = summarize(end)
    if baseline is None:
        if margin is not None:
            raise FlexcellError("--margin requires --baseline", hint="--baseline FILE has the results to compare with")
        return summary, None
    with existing_results(baseline) as saved:
        return summary, compare_with_baseline(
            summary.results,
            summary.subject,
            summary.versions,
            saved,
            confidence=summary.sweep.document.confidence,
            margin=margin,
        )


def _report(
    summary: SweepSummary,
    comparison: Comparison | None,
    file: Path,
    files: tuple[Path, ...] | list[Path],
    junit: Path | None,
    *,
    json: bool,
) -> None:
    for each in files:
        write(each, report(summary, comparison, each))
    if junit is not None:
        write_sweep_junit(junit, file, summary, comparison)
    write_github_summary(summary, comparison, os.environ)
    if json:
        sys.stdout.write(report(summary, comparison, Path("report.json")).decode() + "\n")
    else:
        sys.stdout.write(markdown(summary, comparison))


def _exit_code(summary: SweepSummary, comparison: Comparison | None) -> ExitCode:
    if summary.ended_by == "interrupted" and summary.verdict not in ("passed", "failed"):
        return ExitCode.INTERRUPTED
    verdicts = {summary.verdict, comparison.verdict if comparison is not None else None}
    if "failed" in verdicts:
        return ExitCode.OTHER_OUTCOME
    return ExitCode.UNDECIDED if "undecided" in verdicts else ExitCode.SUCCESS

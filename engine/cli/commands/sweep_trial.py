"""`flexcell sweep rerun` and `shrink`: what is done with one run of a sweep or search that has a result."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.cli.exit_code import ExitCode
from engine.cli.output.output_file import prepare, write
from engine.cli.output.shrink_output import show_shrinking, shrunk_text
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
from engine.cli.sweep_choice import chosen_result
from engine.cli.sweep_options import SweepOverrides
from engine.sweep import Trials
from engine.sweep.case_file import case_document
from engine.sweep.shrinking import SameAs
from engine.sweep.sweep_table import DEFAULT_RESULTS
from engine.sweep.trial_shrinking import MOST_RUNS, shrink_trial


def rerun(
    file: File,
    number: Annotated[int, typer.Argument(help="The number of the configuration.", min=0, show_default=False)],
    vary: Vary = None,
    runs: Runs = None,
    design: Design = None,
    search: Search = None,
    method: Method = None,
    seed: Seed = None,
    cell: Cell = None,
    simulate: Simulate = None,
    parameter: Parameter = None,
    results: Results = DEFAULT_RESULTS,
    record: Annotated[Path | None, typer.Option(help="Record the run to this MCAP file.")] = None,
) -> None:
    """Execute one configuration again in this process, and say whether it ends as its saved result."""
    prepare(record)
    overrides = SweepOverrides(
        vary=tuple(vary or ()),
        runs=runs,
        design=design,
        seed=seed,
        cell=cell,
        simulate=simulate or (),
        parameters=tuple(parameter or ()),
        search=search,
        method=method,
    )
    subject, saved = chosen_result(file, overrides, results, number)
    result = Trials(subject).run(saved.configuration, record=record)
    same = (result.label, result.events_sha256) == (saved.label, saved.events_sha256)
    sys.stdout.write(f"#{number}: {result.label}{f': {result.cause}' if result.cause else ''}\n")
    sys.stdout.write("the same events as before\n" if same else f"it was {saved.label} before: DIFFERENT\n")
    raise typer.Exit(ExitCode.SUCCESS if same else ExitCode.REPLAY_DIFFERS)


def shrink(
    file: File,
    number: Annotated[int, typer.Argument(help="The number of a failing configuration.", min=0, show_default=False)],
    vary: Vary = None,
    runs: Runs = None,
    design: Design = None,
    search: Search = None,
    method: Method = None,
    seed: Seed = None,
    cell: Cell = None,
    simulate: Simulate = None,
    parameter: Parameter = None,
    results: Results = DEFAULT_RESULTS,
    same: Annotated[
        SameAs,
        typer.Option(help="What must stay the same: how the run ends, or its root cause too."),
    ] = "outcome",
    most: Annotated[int, typer.Option(help="Runs at most.", min=1)] = MOST_RUNS,
    record: Annotated[Path | None, typer.Option(help="Record the smallest failing run to this MCAP file.")] = None,
    case: Annotated[
        Path | None, typer.Option(help="Write it as a sweep of one run that requires success: a regression test.")
    ] = None,
) -> None:
    """Find the smallest change from nominal with which a run still fails as this one did."""
    prepare(record, case)
    overrides = SweepOverrides(
        vary=tuple(vary or ()),
        runs=runs,
        design=design,
        seed=seed,
        cell=cell,
        simulate=simulate or (),
        parameters=tuple(parameter or ()),
        search=search,
        method=method,
    )
    subject, failing = chosen_result(file, overrides, results, number)
    found = shrink_trial(subject, failing, same=same, most_runs=most, show=show_shrinking)
    sys.stdout.write(shrunk_text(found))
    if record is not None:
        executed = subject if found.placement_noise else subject.without_placement_noise()
        Trials(executed).run(found.result.configuration, record=record)
        sys.stdout.write(f"recorded to {record}\n")
    if case is not None:
        write(case, case_document(subject.sweep, found.result, case, placement_noise=found.placement_noise))
        sys.stdout.write(f"`flexcell sweep {case}` fails until it is mended\n")

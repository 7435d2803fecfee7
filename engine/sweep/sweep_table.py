"""Sweeps for scripts and notebooks: `run_sweep(file)` returns a table."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from engine.document.duration import seconds
from engine.document.sweep import Sweep, load_sweep
from engine.errors import DocumentError
from engine.host.state_folder_names import STATE_FOLDER
from engine.sweep.cluster.cluster_executor import ClusterOptions
from engine.sweep.design.designs import configurations
from engine.sweep.execution.worker_pool import WorkerOptions
from engine.sweep.report import report
from engine.sweep.report.result_rows import Row, rows
from engine.sweep.results import SweepResults
from engine.sweep.subject.sweep_subject import SweepSubject
from engine.sweep.summary import SweepSummary, summarize
from engine.sweep.sweep_execution import SweepProgress, execute_sweep
from engine.sweep.verdict.comparison import Comparison
from engine.sweep.verdict.judged_requirement import require_known_numbers

DEFAULT_RESULTS = Path(STATE_FOLDER) / "sweeps.db"
"""Where results are kept, relative to the current directory."""


@dataclass(frozen=True)
class SweepTable:
    """The results of a sweep: iterate it for one flat row a run, or give `rows` to a table library."""

    summary: SweepSummary

    @property
    def rows(self) -> list[Row]:
        """One flat row for each run, with equal keys: number, seed, factors, outcome, success, times and outputs."""
        return rows(self.summary.results)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.summary.results)

    def save(self, file: Path | str, comparison: Comparison | None = None) -> None:
        """Write a report: `.md`, `.html`, `.json`, `.csv` or `.parquet`.

        Raises:
            FlexcellError: there is no report of this suffix, or what it needs is not installed.
            OSError: the file cannot be written.
        """
        Path(file).write_bytes(report(self.summary, comparison, Path(file)))


def run_sweep(
    sweep: Sweep | Path | str,
    *,
    results: Path | str = DEFAULT_RESULTS,
    workers: int | None = None,
    cluster: ClusterOptions | None = None,
    show: Callable[[SweepProgress], None] = lambda _progress: None,
) -> SweepTable:
    """Execute what is left of a sweep in worker processes and return all its results.

    Args:
        sweep: The sweep or its file.
        results: File in which results are found and saved.
        workers: Number of processes; by default that of the processors.
        cluster: A Dask cluster that executes the runs; by default processes of this machine do.
        show: Called after each run.

    Raises:
        FlexcellError: the sweep or a document that it names has errors, results cannot be saved, or no run
            has a number that is limited; what was saved stays.
    """
    loaded = sweep if isinstance(sweep, Sweep) else load_sweep(sweep)
    if loaded.document.search is not None:
        hint = "`engine.sweep.search.run_search`, or remove `search`"
        raise DocumentError("the sweep is a search, which has no success rate", where=loaded.file, hint=hint)
    subject = SweepSubject.load(loaded)
    timeout_s = seconds(loaded.document.timeout)
    options = (
        replace(cluster, timeout_s=timeout_s)
        if cluster is not None
        else WorkerOptions(workers=workers or available_processors(), timeout_s=timeout_s)
    )
    with SweepResults.open(Path(results)) as saved:
        end = execute_sweep(subject, configurations(loaded), saved, options, show=show)
    require_known_numbers(loaded, end.results)
    return SweepTable(summarize(end))


def available_processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

"""Searches for scripts and notebooks: `run_search(file)` returns what was found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from engine.document.duration import seconds
from engine.document.sweep import Sweep, load_sweep
from engine.errors import DocumentError
from engine.sweep.execution.worker_pool import WorkerOptions
from engine.sweep.results import SweepResults
from engine.sweep.search.search_execution import SearchProgress, execute_search
from engine.sweep.search.search_summary import SearchSummary, summarize_search
from engine.sweep.subject.sweep_subject import SweepSubject
from engine.sweep.sweep_table import DEFAULT_RESULTS, available_processors


def run_search(
    sweep: Sweep | Path | str,
    *,
    results: Path | str = DEFAULT_RESULTS,
    workers: int | None = None,
    show: Callable[[SearchProgress], None] = lambda _progress: None,
) -> SearchSummary:
    """Execute what is left of a search in worker processes and return what it found.

    Args:
        sweep: A sweep with a search, or its file.
        results: File in which results are found and saved.
        workers: Number of processes; by default that of the processors.
        show: Called after each run.

    Raises:
        FlexcellError: the sweep has no search or has errors, or results cannot be saved.
    """
    loaded = sweep if isinstance(sweep, Sweep) else load_sweep(sweep)
    if loaded.document.search is None:
        raise DocumentError("the sweep has no search", where=loaded.file, hint="`search: {towards: failure}`")
    subject = SweepSubject.load(loaded)
    options = WorkerOptions(workers=workers or available_processors(), timeout_s=seconds(loaded.document.timeout))
    with SweepResults.open(Path(results)) as saved:
        return summarize_search(execute_search(subject, saved, options, show=show))

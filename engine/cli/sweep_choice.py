"""One run of a sweep or search, chosen by its number, from the results that are saved."""

from __future__ import annotations

from pathlib import Path

from engine.cli.sweep_options import SweepOverrides, read_sweep
from engine.errors import FlexcellError
from engine.sweep import SweepResults, SweepSubject, TrialResult, configurations
from engine.sweep.search import saved_search


def chosen_result(
    file: Path, overrides: SweepOverrides, results: Path, number: int
) -> tuple[SweepSubject, TrialResult]:
    """Return the subject of a sweep and one of its saved results.

    Raises:
        FlexcellError: the sweep has errors, or there is no such result.
    """
    sweep = read_sweep(file, overrides)
    subject = SweepSubject.load(sweep)
    if sweep.document.search is not None:
        with existing_results(results) as saved:
            steps = saved_search(subject, saved).steps
        if number >= len(steps):
            hint = f"it has results of {len(steps)} runs, from 0; search first, with the same options"
            raise FlexcellError(f"the search has no run {number}", where=file, hint=hint)
        return subject, steps[number].result
    planned = configurations(sweep)
    if number >= len(planned):
        raise FlexcellError(f"the sweep has no configuration {number}", where=file, hint=f"0 to {len(planned) - 1}")
    with existing_results(results) as saved:
        key = planned[number].key(subject.hash)
        found = saved.of(subject.hash, [key]).get(key)
    if found is None:
        hint = "run the sweep first, with the same options; results of other versions are kept apart"
        raise FlexcellError(f"configuration {number} has no result in {results}", where=file, hint=hint)
    return subject, found


def existing_results(results: Path) -> SweepResults:
    """Open a file of results that exists.

    Raises:
        FlexcellError: it does not exist, or cannot be opened.
    """
    if not results.is_file():
        raise FlexcellError("there are no results yet", where=results, hint="`flexcell sweep FILE` executes a sweep")
    return SweepResults.open(results)

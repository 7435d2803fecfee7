"""Sweeps and searches with results that were executed in this process, and what a page gets of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec

from engine.document.sweep import load_sweep
from engine.sweep import SweepResults, SweepSubject, Trials, configurations
from engine.sweep.search.search_plan import SearchPlan
from engine.sweep_library.sweep_process import answer
from engine.sweep_library.sweep_reader import SweepReader
from engine.sweep_library.sweep_requests import Answered, Refused, SweepRequest

ID = "sweep.yaml"


def execute_runs(project: Path, runs: int, results: Path | None = None) -> None:
    """Execute the first runs of the sweep of a project; by default into the results of the project."""
    sweep = load_sweep(project / ID)
    subject = SweepSubject.load(sweep)
    trials = Trials(subject)
    with SweepResults.open(results or SweepReader(project).results) as saved:
        saved.describe(subject.hash, subject.versions)
        for each in configurations(sweep)[:runs]:
            saved.save(each.key(subject.hash), subject.hash, trials.run(each))


def execute_batches(project: Path, batches: int) -> None:
    """Execute the first batches of the search of a project."""
    subject = SweepSubject.load(load_sweep(project / ID))
    trials, plan = Trials(subject), SearchPlan(subject.sweep)
    with SweepResults.open(SweepReader(project).results) as saved:
        saved.describe(subject.hash, subject.versions)
        for _ in range(batches):
            found = [trials.run(point.configuration) for point in plan.due()]
            for each in found:
                saved.save(each.configuration.key(subject.hash), subject.hash, each)
            plan.take(found)


def read(project: Path, request: SweepRequest) -> Any:
    """What the page gets."""
    found = answer(SweepReader(project), request, lambda _: None)
    assert isinstance(found, Answered), found
    return msgspec.json.decode(found.body)


def refused(project: Path, request: SweepRequest) -> Refused:
    """Why the page gets nothing."""
    found = answer(SweepReader(project), request, lambda _: None)
    assert isinstance(found, Refused)
    return found

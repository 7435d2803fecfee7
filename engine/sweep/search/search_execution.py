"""Executes what is left of a search, batch by batch: saves every result, and ends with the failures it is for.

A batch begins after the last one has ended, so that what it consists of does not depend on the number of workers.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from engine.document.duration import seconds
from engine.document.sweep import SearchSpec
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_execution import ExecutionOptions
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.results import SweepResults
from engine.sweep.search.sampler import SearchPoint
from engine.sweep.search.search_plan import SearchPlan, SearchStep
from engine.sweep.search.target import SearchTarget, is_failure
from engine.sweep.subject.sweep_subject import SweepSubject

SearchEndedBy = Literal["runs", "failures", "time", "interrupted"]


@dataclass(frozen=True, kw_only=True)
class SearchProgress:
    """How far a search is."""

    batch: int
    """From 0."""
    done: int
    planned: int
    executed: int
    """Runs executed by this process; the others were saved before."""
    failures: int
    nearest: TrialResult | None
    """The run that succeeded and is nearest to failure."""
    target: SearchTarget
    elapsed_s: float


@dataclass(frozen=True, kw_only=True)
class SearchEnd:
    """The runs of a search without a gap before them, those of earlier executions included."""

    subject: SweepSubject
    spec: SearchSpec
    target: SearchTarget
    steps: Sequence[SearchStep]
    ended_by: SearchEndedBy
    executed: int = 0


def saved_search(subject: SweepSubject, results: SweepResults) -> SearchEnd:
    """Return what is saved of a search, without executing anything.

    Raises:
        FlexcellError: results cannot be read, or no run has the number that is searched for.
    """
    plan = SearchPlan(subject.sweep)
    while batch := plan.due():
        found = _saved(subject, batch, results)
        plan.take(_without_gap(batch, found))
        if len(found) < len(batch):
            return _end(subject, plan, "failures" if plan.is_satisfied else "interrupted")
    return _end(subject, plan, "failures" if plan.is_satisfied else "runs")


def execute_search(
    subject: SweepSubject,
    results: SweepResults,
    options: ExecutionOptions,
    *,
    again: bool = False,
    show: Callable[[SearchProgress], None] = lambda _progress: None,
) -> SearchEnd:
    """Execute the configurations of a search without a saved result; Ctrl-C ends it, and keeps what has ended.

    Args:
        subject: What all have in common; its sweep has a search.
        results: Where results are saved and found.
        options: Where and how they are executed.
        again: Whether configurations whose process crashed or hung are executed again. If they end differently, later
            batches consist of other configurations.
        show: Called after each run and each batch that was saved before.

    Raises:
        FlexcellError: results cannot be saved, workers not be started, or no run has the number that is searched for;
            what was saved stays.
    """
    plan = SearchPlan(subject.sweep)
    results.describe(subject.hash, subject.versions)
    document = subject.sweep.document
    started_s = time.monotonic()
    deadline_s = started_s + seconds(document.time) if document.time is not None else None
    executed = 0
    ended_by: SearchEndedBy = "runs"
    with options.new_executor(subject) as executor:
        while batch := plan.due():
            found = _saved(subject, batch, results, again=again)
            # The failures that end a search count without a gap: which ones they are does not depend on the workers.
            waiting = iter([point.configuration for point in batch if point.configuration.number not in found])

            def due() -> Configuration | None:
                nonlocal ended_by
                if deadline_s is not None and time.monotonic() >= deadline_s:
                    ended_by = "time"
                    return None
                return None if _would_satisfy(plan, _without_gap(batch, found)) else next(waiting, None)  # noqa: B023

            try:
                show(_progress(plan, batch, found, executed, started_s))
                for result in executor.results(iter(due, None)):
                    results.save(result.configuration.key(subject.hash), subject.hash, result, replace=again)
                    found[result.configuration.number] = result
                    executed += 1
                    show(_progress(plan, batch, found, executed, started_s))
            except KeyboardInterrupt:
                ended_by = "interrupted"
                # One that was saved may not have been taken yet.
                found |= _saved(subject, batch, results, again=again)
            plan.take(_without_gap(batch, found))
            if len(found) < len(batch):
                break
    if plan.is_satisfied:
        ended_by = "failures"
    return _end(subject, plan, ended_by, executed)


def _would_satisfy(plan: SearchPlan, results: Sequence[TrialResult]) -> bool:
    limit = plan.spec.stop_after
    return limit is not None and plan.failures + sum(map(is_failure, results)) >= limit


def _without_gap(batch: Sequence[SearchPoint], found: dict[int, TrialResult]) -> list[TrialResult]:
    kept: list[TrialResult] = []
    for point in batch:
        result = found.get(point.configuration.number)
        if result is None:
            break
        kept.append(result)
    return kept


def _saved(
    subject: SweepSubject, batch: Sequence[SearchPoint], results: SweepResults, *, again: bool = False
) -> dict[int, TrialResult]:
    """Return the saved results of a batch by number; a random design may have executed some of them."""
    return results.of_design(subject.hash, [point.configuration for point in batch], again=again)


def _progress(
    plan: SearchPlan, batch: Sequence[SearchPoint], found: dict[int, TrialResult], executed: int, started_s: float
) -> SearchProgress:
    ended = [*(step.result for step in plan.steps), *found.values()]
    passed = [each for each in ended if each.success]
    return SearchProgress(
        batch=batch[0].batch,
        done=len(ended),
        planned=plan.spec.runs,
        executed=executed,
        failures=sum(map(is_failure, ended)),
        nearest=min(passed, key=plan.target.score) if passed else None,
        target=plan.target,
        elapsed_s=time.monotonic() - started_s,
    )


def _end(subject: SweepSubject, plan: SearchPlan, ended_by: SearchEndedBy, executed: int = 0) -> SearchEnd:
    return SearchEnd(
        subject=subject,
        spec=plan.spec,
        target=plan.target,
        steps=plan.steps,
        ended_by=ended_by,
        executed=executed,
    )

"""Executes what is left of a sweep: saves every result, counts it, and ends as soon as nothing more is needed."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from engine.document.duration import seconds
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_execution import ExecutionOptions
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.results import SweepResults
from engine.sweep.subject.sweep_subject import SweepSubject
from engine.sweep.verdict.success_count import SuccessCount

EndedBy = Literal["runs", "decided", "time", "interrupted"]


@dataclass(frozen=True, kw_only=True)
class Shard:
    """One of `count` parts of a sweep that are executed apart and merged: every `count`-th configuration."""

    index: int = 0
    count: int = 1

    def has(self, configuration: Configuration) -> bool:
        """Return whether a configuration is in this part."""
        return configuration.number % self.count == self.index


@dataclass(frozen=True, kw_only=True)
class SweepProgress:
    """How far a sweep is."""

    count: SuccessCount
    executed: int
    """Runs executed by this process; the others were saved before."""
    due: int
    """Runs that are left, unless the sweep ends before."""
    elapsed_s: float

    @property
    def rate_hz(self) -> float:
        """Runs per second of wall time."""
        return self.executed / self.elapsed_s if self.elapsed_s > 0.0 else 0.0

    @property
    def remaining_s(self) -> float | None:
        """Wall time that the runs that are left take at this rate; None before the first one has ended."""
        return self.due / self.rate_hz if self.executed else None


@dataclass(frozen=True, kw_only=True)
class SweepEnd:
    """The results of a sweep, those of earlier executions included, in the order of configurations."""

    subject: SweepSubject
    configurations: Sequence[Configuration]
    """All that the design has."""
    results: Sequence[TrialResult]
    count: SuccessCount
    ended_by: EndedBy
    executed: int = 0


def saved_sweep(subject: SweepSubject, configurations: Sequence[Configuration], results: SweepResults) -> SweepEnd:
    """Return what is saved of a sweep, without executing anything."""
    found = results.of_design(subject.hash, configurations)
    count = _counted(found, subject, configurations)
    complete = len(found) == len(configurations)
    return SweepEnd(
        subject=subject,
        configurations=configurations,
        results=[found[number] for number in sorted(found)],
        count=count,
        ended_by="runs" if complete else "decided" if count.is_decided else "interrupted",
    )


def execute_sweep(
    subject: SweepSubject,
    configurations: Sequence[Configuration],
    results: SweepResults,
    options: ExecutionOptions,
    *,
    shard: Shard | None = None,
    again: bool = False,
    show: Callable[[SweepProgress], None] = lambda _progress: None,
) -> SweepEnd:
    """Execute the configurations without a saved result; Ctrl-C ends it, and keeps what has ended.

    Args:
        subject: What all have in common.
        configurations: The design.
        results: Where results are saved and found.
        options: Where and how they are executed.
        shard: The part that is executed here; by default all. A part does not end early: the others may decide else.
        again: Whether configurations whose process crashed or hung are executed again.
        show: Called after each result.

    Raises:
        FlexcellError: results cannot be saved, or workers not be started; what was saved stays.
    """
    part = shard or Shard()
    document = subject.sweep.document
    results.describe(subject.hash, subject.versions)
    found = results.of_design(subject.hash, configurations, again=again)
    count = _counted(found, subject, configurations)
    due = [each for each in configurations if each.number not in found and part.has(each)]
    started_s = time.monotonic()
    deadline_s = started_s + seconds(document.time) if document.time is not None else None
    executed = 0
    ended_by: EndedBy = "runs"

    def remaining() -> Iterator[Configuration]:
        """Yield what is due until nothing more is needed; what has begun then still ends."""
        nonlocal ended_by
        for configuration in due:
            if part.count == 1 and count.is_decided:
                ended_by = "decided"
                return
            if deadline_s is not None and time.monotonic() >= deadline_s:
                ended_by = "time"
                return
            yield configuration

    with options.new_executor(subject) as executor:
        try:
            for result in executor.results(remaining()):
                results.save(result.configuration.key(subject.hash), subject.hash, result, replace=again)
                found[result.configuration.number] = result
                count.add(result)
                executed += 1
                show(
                    SweepProgress(
                        count=count,
                        executed=executed,
                        due=len(due) - executed,
                        elapsed_s=time.monotonic() - started_s,
                    )
                )
        except KeyboardInterrupt:
            ended_by = "interrupted"
            # One that was saved may not have been counted yet.
            found |= results.of_design(subject.hash, configurations, again=again)
            count = _counted(found, subject, configurations)
    return SweepEnd(
        subject=subject,
        configurations=configurations,
        results=[found[number] for number in sorted(found)],
        count=count,
        ended_by=ended_by,
        executed=executed,
    )


def _counted(
    found: Mapping[int, TrialResult], subject: SweepSubject, configurations: Sequence[Configuration]
) -> SuccessCount:
    count = SuccessCount(subject.sweep.document, len(configurations))
    for number in sorted(found):
        count.add(found[number])
    return count

"""Shrinks a failing run of a sweep, by runs in this process."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from engine.sweep.execution.trial import Trials
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.shrinking import SameAs, ShrinkProgress, Shrunk, same_cause, same_outcome, shrink
from engine.sweep.subject.sweep_subject import SweepSubject

MOST_RUNS = 200
_SAME = {"outcome": same_outcome, "cause": same_cause}


def shrink_trial(
    subject: SweepSubject,
    failing: TrialResult,
    *,
    same: SameAs = "outcome",
    most_runs: int = MOST_RUNS,
    show: Callable[[ShrinkProgress], None] = lambda _progress: None,
) -> Shrunk:
    """Return the smallest change from nominal with which a run still fails; see `engine.sweep.shrinking`.

    Args:
        subject: What the runs of its sweep have in common.
        failing: The run.
        same: What must stay the same.
        most_runs: The runs after which the smallest one found so far is returned.
        show: Called after each run.

    Raises:
        ControlError: the run succeeded.
    """
    document = subject.sweep.document
    quiet = Trials(subject.without_placement_noise()).run if document.placement_noise else None
    found = shrink(
        failing,
        document.factors,
        subject.nominal,
        Trials(subject).run,
        quiet=quiet,
        same=_SAME[same],
        most_runs=most_runs,
        show=show,
    )
    return replace(found, placement_noise=found.placement_noise and document.placement_noise)

"""Whether a share of runs that is required is reached, and the interval by which this is judged."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from engine.document.requirement import Requirement
from engine.document.sweep import Sweep, SweepDocument
from engine.sweep.execution.trial_result import TrialResult, require_number
from engine.sweep.statistics import Interval, exact_interval, rate_interval

Verdict = Literal["passed", "failed", "undecided"]


@dataclass(frozen=True, kw_only=True)
class JudgedRequirement:
    """What the runs of a sweep that are looked at say about one requirement."""

    text: str
    number: str | None
    """The name of the number that is limited; None of a success rate."""
    runs: int
    kept: int
    """Of these, those that keep it."""
    missing: int
    """Those of them that have no number of its name: they do not keep it."""
    interval: Interval | None
    """Of the share of all runs that keep it; None where the design has none, or its runs are not done."""
    verdict: Verdict


def share_interval(kept: int, runs: int, document: SweepDocument, *, planned: int, among: int = 1) -> Interval | None:
    """Return the interval of the share of all runs that keep something; None where the design has none.

    Args:
        kept: Runs that keep it.
        runs: The runs that are looked at.
        document: The sweep.
        planned: The number of configurations.
        among: The number of requirements that are judged together. Where all hold, a mistake about any of them fails
            the sweep: the upper end of each has its part of the error. Where one does not hold, only a mistake about
            that one lets the sweep pass: the lower end has all of it.
    """
    if document.design != "random" or (document.interval == "exact" and runs < planned):
        return None
    interval_at = rate_interval if document.interval == "anytime" else exact_interval
    found = interval_at(kept, runs, confidence=document.confidence)
    if among == 1:
        return found
    shared = interval_at(kept, runs, confidence=1.0 - (1.0 - document.confidence) / among)
    return Interval(found.low, shared.high)


def judged(
    requirement: Requirement, document: SweepDocument, *, kept: int, missing: int, runs: int, planned: int, among: int
) -> JudgedRequirement:
    """Return whether one of the requirements of a sweep is reached.

    Args:
        requirement: The requirement.
        document: The sweep.
        kept: Runs that keep it.
        missing: Runs without its number.
        runs: The runs that are looked at.
        planned: The number of configurations.
        among: The number of requirements of the sweep.
    """
    interval = share_interval(kept, runs, document, planned=planned, among=among)
    if document.design != "random":
        verdict = _verdict_of_all(requirement.rate, kept, runs, planned)
    elif interval is None:
        verdict = "undecided"
    else:
        verdict = _verdict(requirement.rate, interval)
    return JudgedRequirement(
        text=requirement.text,
        number=requirement.limit.name if requirement.limit is not None else None,
        runs=runs,
        kept=kept,
        missing=missing,
        interval=interval,
        verdict=verdict,
    )


def require_known_numbers(sweep: Sweep, results: Iterable[TrialResult]) -> None:
    """Reject a sweep that limits a number which none of the runs that succeeded has.

    Raises:
        FlexcellError: there are such runs, and none has the number; the hint names similar ones.
    """
    known = [each for each in results if each.success]
    for requirement in sweep.document.requirements:
        if requirement.limit is not None:
            require_number(requirement.limit.name, known, where=sweep.source.position(("require",)))


def verdict_of(requirements: Sequence[JudgedRequirement]) -> Verdict | None:
    """Return the verdict of several: failed where one is, else undecided where one is; None of none."""
    verdicts = {each.verdict for each in requirements}
    return next((each for each in ("failed", "undecided", "passed") if each in verdicts), None)


def _verdict(required: float, interval: Interval) -> Verdict:
    if interval.low >= required:
        return "passed"
    return "failed" if interval.high < required else "undecided"


def _verdict_of_all(required: float, kept: int, runs: int, planned: int) -> Verdict:
    """Return the verdict of a design without an interval: its share of all runs is compared."""
    if runs == planned:
        return "passed" if kept >= required * planned else "failed"
    return "failed" if planned - (runs - kept) < required * planned else "undecided"

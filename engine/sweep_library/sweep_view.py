"""What a user interface shows of the sweeps of a project."""

from __future__ import annotations

from dataclasses import fields
from typing import Literal, get_type_hints

import msgspec

from engine.document.sweep import SweepDocument
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.statistics import Interval
from engine.sweep.summary import SweepSummary
from engine.sweep.verdict.judged_requirement import Verdict
from engine.sweep.verdict.success_count import SuccessCount

SweepStatus = Literal["idle", "running", "stopping"]
_APART = frozenset({"sweep", "results"})
"""What is of_head otherwise: the document of a sweep as it is, its results by `SweepRuns`."""


class SearchLive(msgspec.Struct, frozen=True, kw_only=True):
    """How far a search for failures is."""

    failures: int
    nearest: float | None
    """The number that is searched for, of the success that is nearest to failure."""
    is_satisfied: bool = False
    """Whether as many failures are found as it is for."""


class SweepLive(msgspec.Struct, frozen=True, kw_only=True):
    """How far a sweep is. `looked_at` counts the runs without a gap before them: rate and interval are of those."""

    status: SweepStatus = "idle"
    planned: int = 0
    done: int = 0
    looked_at: int = 0
    successes: int = 0
    interval: Interval | None = None
    verdict: Verdict | None = None
    rate_hz: float = 0.0
    """Runs per second of wall time, while it is running."""
    remaining_s: float | None = None
    """Wall time that the runs that are left take; a decided sweep ends before."""
    search: SearchLive | None = None
    """Of a search; it has no rate, as its runs were chosen."""
    problem: str = ""
    """Why its execution has ended, where that was not as it should be."""


class SweepLine(msgspec.Struct, frozen=True, kw_only=True):
    """One line of the list of sweeps; `id` is the path of the document in the project."""

    id: str
    description: str = ""
    behavior: str = ""
    """The path of the behavior in the project, or as it is written where that leads out of it."""
    design: str = ""
    require: str = ""
    """What is required, separated by semicolons."""
    towards: str = ""
    """What a search goes towards; empty for a design."""
    factors: tuple[str, ...] = ()
    live: SweepLive = SweepLive()
    problem: str = ""
    """Why it cannot be executed and its results are not known; else empty."""


class UndescribedResults(msgspec.Struct, frozen=True, kw_only=True):
    """Saved results that no sweep document of the project asks for: of the command line, or of an earlier version."""

    subject: str
    """The hash of what all these runs have in common."""
    behavior: str
    """The path of the behavior, if the project still has this version of it; else empty."""
    runs: int
    successes: int


class SweepList(msgspec.Struct, frozen=True, kw_only=True):
    """The sweeps of a project, and the results that belong to none of them."""

    sweeps: tuple[SweepLine, ...]
    others: tuple[UndescribedResults, ...]


class CurvePoint(msgspec.Struct, frozen=True, kw_only=True):
    """What a number of runs has shown of the success rate; a design that is not random has no interval."""

    runs: int
    rate: float
    interval: Interval | None


class SweepHead(msgspec.Struct, frozen=True, kw_only=True):
    """A sweep with how its interval has narrowed."""

    line: SweepLine
    document: SweepDocument
    curve: tuple[CurvePoint, ...]


_HINTS = get_type_hints(SweepSummary)
_FIGURES = tuple(each.name for each in fields(SweepSummary) if each.name not in _APART)
SweepView = msgspec.defstruct(
    "SweepView", [(name, _HINTS[name]) for name in _FIGURES], bases=(SweepHead,), frozen=True, kw_only=True
)
"""A sweep with everything that its summary tells, under the same names."""


class SweepRuns(msgspec.Struct, frozen=True, kw_only=True):
    """Runs of a sweep without their times in nodes, failing ones first, each in the order of configurations.

    `alike` has the numbers of all failing runs with the same cause, the most frequent cause first.
    """

    runs: tuple[TrialResult, ...]
    total: int
    alike: tuple[tuple[int, ...], ...]


class RecordedTrial(msgspec.Struct, frozen=True, kw_only=True):
    """A run of a sweep that was executed again and recorded to `recording`, a path in the project."""

    recording: str
    same: bool
    """Whether it ended as before, with the same events."""
    result: TrialResult
    saved: TrialResult


class FactorChoice(msgspec.Struct, frozen=True, kw_only=True):
    """A value of a behavior or its cell that a sweep can vary, with its value where nothing is varied."""

    address: str
    nominal: object
    unit: str = ""
    description: str = ""
    least: float | None = None
    most: float | None = None
    options: tuple[object, ...] = ()
    """All its values, where it has only a few."""


def view_of(head: SweepHead, summary: SweepSummary) -> msgspec.Struct:
    """Return a `SweepView`."""
    of_head = {name: getattr(head, name) for name in SweepHead.__struct_fields__}
    return SweepView(**of_head, **{name: getattr(summary, name) for name in _FIGURES})


def live_of(count: SuccessCount) -> SweepLive:
    """Return how far a sweep is that is not being executed."""
    return SweepLive(
        planned=count.planned,
        done=count.done,
        looked_at=count.looked_at,
        successes=count.successes,
        interval=count.interval,
        verdict=count.verdict,
    )

"""Trends over the last runs of a behavior: how many succeeded, and how long runs and their nodes took."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from statistics import median, quantiles

import msgspec

from engine.archive.archive import Archive
from engine.archive.past_runs import PastRun
from engine.archive.run_alignment import Visit, visits_of
from engine.archive.run_comparison import duration_s
from engine.errors import JournalError
from engine.journal import read_events


class DurationSpread(msgspec.Struct, frozen=True, kw_only=True):
    """How long something took in `count` runs, in seconds: the median, the quartiles, the extremes.

    `last_s` is that of the latest run of all, however it ended; null where that run did not have it or has not ended.
    """

    count: int
    median_s: float
    lower_s: float
    upper_s: float
    least_s: float
    most_s: float
    last_s: float | None


class NodeTrend(DurationSpread, frozen=True, kw_only=True):
    """How long all visits of a node together took in a run."""

    path: str


class RunTrend(msgspec.Struct, frozen=True, kw_only=True):
    """The last runs of a behavior, newest first, of `known` in the journal.

    Each is counted once: it `succeeded`, `failed`, was `stopped`, or has `not_ended`. Durations are those of runs that
    succeeded, `duration` is null and `nodes` empty where there is none.
    """

    behavior: str
    runs: tuple[PastRun, ...]
    known: int
    succeeded: int
    failed: int
    stopped: int
    not_ended: int
    duration: DurationSpread | None
    nodes: tuple[NodeTrend, ...]


class RunTrends:
    """Trends of the behaviors of an archive; each run that is over is read once. Thread-safe.

    Args:
        archive: The past runs.
    """

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._lock = threading.Lock()
        self._durations: dict[tuple[str, int], Mapping[str, float]] = {}

    def of(self, behavior: str, *, last: int) -> RunTrend:
        """Return the trend of a behavior, by its name, over at most `last` runs.

        Raises:
            JournalError: the journal cannot be read.
        """
        return run_trend(behavior, self._archive.runs(), self._node_durations, last=last)

    def _node_durations(self, run: PastRun) -> Mapping[str, float]:
        # A resumed run has more events.
        key = (run.id, run.events)
        with self._lock:
            known = self._durations.get(key)
        if known is not None:
            return known
        try:
            durations = node_durations(visits_of(read_events(self._archive.journal, run.id)))
        except JournalError:
            # Damaged: it is counted as failed, and the others still have durations.
            durations = {}
        with self._lock:
            self._durations[key] = durations
        return durations


def run_trend(
    behavior: str, runs: Sequence[PastRun], durations: Callable[[PastRun], Mapping[str, float]], *, last: int
) -> RunTrend:
    """Return the trend of a behavior.

    Args:
        behavior: Its name, as runs have it.
        runs: All runs, newest first; those of other behaviors are left out.
        durations: Returns how long the nodes of a run took, by path in seconds; see `node_durations`.
        last: Number of runs that are looked at, at most.
    """
    known = [run for run in runs if run.behavior == behavior]
    shown = known[:last]
    good = [run for run in shown if run.success]
    latest = shown[0] if shown and shown[0].status != "running" else None
    latest_nodes: Mapping[str, float] = durations(latest) if latest is not None else {}
    by_path: dict[str, list[float]] = {}
    for run in good:
        for path, seconds in durations(run).items():
            by_path.setdefault(path, []).append(seconds)
    return RunTrend(
        behavior=behavior,
        runs=tuple(shown),
        known=len(known),
        succeeded=len(good),
        failed=sum(run.failed for run in shown),
        stopped=sum(run.status == "stopped" for run in shown),
        not_ended=sum(run.status == "running" for run in shown),
        duration=_spread([run.duration_s for run in good], latest.duration_s if latest is not None else None)
        if good
        else None,
        nodes=tuple(
            NodeTrend(**msgspec.structs.asdict(_spread(seconds, latest_nodes.get(path))), path=path)
            for path, seconds in by_path.items()
        ),
    )


def node_durations(visits: Iterable[Visit]) -> dict[str, float]:
    """Return how long all visits of each node took together, by path in seconds."""
    sums: dict[str, float] = {}
    for visit in visits:
        sums[visit.path] = sums.get(visit.path, 0.0) + duration_s(visit)
    return sums


def _spread(seconds: Sequence[float], last_s: float | None) -> DurationSpread:
    lower_s, _, upper_s = quantiles(seconds, n=4, method="inclusive") if len(seconds) > 1 else (seconds[0],) * 3
    return DurationSpread(
        count=len(seconds),
        median_s=median(seconds),
        lower_s=lower_s,
        upper_s=upper_s,
        least_s=min(seconds),
        most_s=max(seconds),
        last_s=last_s,
    )

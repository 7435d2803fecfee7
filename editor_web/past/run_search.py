"""Search for past runs by words, status and start time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from engine.archive import PastRun

RunKind = Literal["all", "failed", "finished", "stopped", "running"]
RUN_KINDS: tuple[RunKind, ...] = ("all", "failed", "finished", "stopped", "running")


@dataclass(frozen=True, kw_only=True)
class PastRunQuery:
    """A search query; `since_s` and `until_s` limit the start time, seconds since 1970."""

    text: str
    kind: RunKind
    since_s: float
    until_s: float

    def matches(self, run: PastRun) -> bool:
        """Return whether a run contains all words and started in the time range; the kind is not compared."""
        if not self.since_s <= run.started_at_s <= self.until_s:
            return False
        text = f"{run.id} {run.behavior} {run.status} {run.outcome or ''} {run.cause}".lower()
        return all(word in text for word in self.text.lower().split())


def kind_of(run: PastRun) -> RunKind:
    """Return the kind of a run by its end."""
    if run.failed:
        return "failed"
    match run.status:
        case "finished" | "stopped":
            return run.status
        case _:
            return "running"


def search_runs(
    runs: Sequence[PastRun], query: PastRunQuery, *, offset: int, limit: int
) -> tuple[tuple[PastRun, ...], int, Counter[str]]:
    """Return a page of the matching runs, their number, and the number of runs of each kind."""
    matching = [run for run in runs if query.matches(run)]
    counts: Counter[str] = Counter(map(kind_of, matching))
    counts["all"] = len(matching)
    shown = [run for run in matching if query.kind in ("all", kind_of(run))]
    return tuple(shown[offset : offset + limit]), len(shown), counts

"""Finding past runs: by words, by how they ended, by when they began."""

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
    """What is looked for; `since_s` and `until_s` are of the wall clock, seconds since 1970."""

    text: str
    kind: RunKind
    since_s: float
    until_s: float

    def matches(self, run: PastRun) -> bool:
        """Tell whether a run has all of the words and began in that time, however it ended."""
        if not self.since_s <= run.started_at_s <= self.until_s:
            return False
        said = f"{run.id} {run.behavior} {run.status} {run.outcome or ''} {run.cause}".lower()
        return all(word in said for word in self.text.lower().split())


def kind_of(run: PastRun) -> RunKind:
    """Return how it ended."""
    if run.failed:
        return "failed"
    match run.status:
        case "finished" | "stopped":
            return run.status
        case _:
            return "running"


def search_runs(
    runs: Sequence[PastRun], wanted: PastRunQuery, *, offset: int, limit: int
) -> tuple[tuple[PastRun, ...], int, Counter[str]]:
    """Return a page of what matches, how many match, and how many there are of each kind whatever kind is wanted."""
    matching = [run for run in runs if wanted.matches(run)]
    counts: Counter[str] = Counter(map(kind_of, matching))
    counts["all"] = len(matching)
    shown = [run for run in matching if wanted.kind in ("all", kind_of(run))]
    return tuple(shown[offset : offset + limit]), len(shown), counts

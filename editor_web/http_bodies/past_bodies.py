"""Bodies of past runs and recordings."""

from __future__ import annotations

import msgspec
from msgspec.structs import asdict, replace

from engine.archive import ArchivedRun, PastRun
from engine.library import BehaviorView


class PastRunBody(PastRun, frozen=True, kw_only=True):
    """One run of the journal. `running` means that it has no end: it is active, or its engine died.

    `recording` is the path of its recording, empty if there is none; `here` is true for a run of this server.
    """

    is_failure: bool = msgspec.field(name="failed")
    recording: str
    here: bool


class PastRunsBody(msgspec.Struct, frozen=True, kw_only=True):
    """A page of past runs, newest first, and the number of runs of each kind that match the other filters."""

    runs: tuple[PastRunBody, ...]
    total: int
    counts: dict[str, int]


class OpenRunBody(msgspec.Struct, frozen=True, kw_only=True):
    """An open past run or recording, with the behavior as of the start of the run.

    It is shown as it stands: a run without an end is `interrupted`.
    """

    run: PastRunBody
    behavior: BehaviorView


def open_run_body(archived: ArchivedRun, *, recording: str) -> OpenRunBody:
    """Return an open run."""
    run = archived.summary
    if run.status == "running":
        run = replace(run, status="interrupted")
    return OpenRunBody(run=past_run_body(run, recording=recording), behavior=archived.behavior)


def past_run_body(run: PastRun, *, recording: str, here: bool = False) -> PastRunBody:
    """Return a run with what the server knows of it."""
    return PastRunBody(**asdict(run), is_failure=run.failed, recording=recording, here=here)

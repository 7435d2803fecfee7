"""JSON bodies of past runs and recordings."""

from __future__ import annotations

from editor_web.http_bodies.common_bodies import BehaviorBody, HttpBody


class PastRunBody(HttpBody):
    """One run of the journal. `running` means that it has no end: it is active, or its engine died.

    `recording` is the path of its recording, empty if there is none; `here` is true for a run of this server.
    """

    id: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    failed: bool
    cause: str
    started_at_s: float
    duration_s: float
    events: int
    recording: str = ""
    here: bool = False


class PastRunsBody(HttpBody):
    """A page of past runs, newest first, and the number of runs of each kind that match the other filters."""

    runs: tuple[PastRunBody, ...]
    total: int
    counts: dict[str, int]


class RecordingBody(HttpBody):
    """One recording of the project; `problem` tells why it cannot be opened, empty if it can."""

    path: str
    run: str
    behavior: str
    started_at_s: float
    size_bytes: int
    changed_at_s: float
    problem: str


class OpenRunBody(HttpBody):
    """An open past run or recording, with the behavior as of the start of the run."""

    run: PastRunBody
    behavior: BehaviorBody

"""The JSON of past runs and recordings: their lists, and what opens one."""

from __future__ import annotations

from editor_web.http_bodies.common_bodies import BehaviorBody, HttpBody


class PastRunBody(HttpBody):
    """One run of the journal. `running` without an end: it is under way somewhere, or its engine died.

    `recording` is the path of its recording, empty where there is none; `here` says that it is a run of this server.
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
    """A page of past runs, newest first, and how many there are of each kind that match the other filters."""

    runs: tuple[PastRunBody, ...]
    total: int
    counts: dict[str, int]


class RecordingBody(HttpBody):
    """One recording of the project; `problem` says why it cannot be opened, empty where it can."""

    path: str
    run: str
    behavior: str
    started_at_s: float
    size_bytes: int
    changed_at_s: float
    problem: str


class OpenRunBody(HttpBody):
    """A past run or a recording that is opened: what it was, and the behavior as it was when the run began."""

    run: PastRunBody
    behavior: BehaviorBody

"""Cache of open runs: of this server, of the journal and of recordings."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from editor_web.past.failure import RunFailure, failure_of
from editor_web.past.measured_marker import MeasuredMarkers
from editor_web.past.measured_run import MeasuredRun
from editor_web.past.state_history import PastRunState
from editor_web.past.timeline import RunHistory, Timeline
from editor_web.past.userdata_values import PastUserdata, UserdataCheckpoints
from engine.archive import Archive, ArchivedRun
from engine.errors import FlexcellError
from engine.event import Event
from engine.project import Session
from engine.runtime.history import UserdataHistory, Watch

MAX_OPEN_RUNS = 6
"""Maximum number of open runs; 100,000 events take about 100 MB."""
_EVENTS_PER_YIELD = 256
"""Events processed before yielding to the engine's thread."""


@dataclass(kw_only=True)
class OpenRun:
    """One run with its history; thread-safe; `archived` is None for a run of this server."""

    course: RunHistory
    userdata: UserdataCheckpoints
    archived: ArchivedRun | None = None
    lock: threading.Lock = field(default_factory=threading.Lock)
    measured_run: MeasuredRun = field(default_factory=MeasuredRun)

    def follow(self, events: Iterable[Event]) -> None:
        """Apply further events."""
        with self.lock:
            for count, event in enumerate(events, 1):
                self.course.follow(event)
                if count % _EVENTS_PER_YIELD == 0:
                    # Runs beside the engine's thread, which a long loop must not block.
                    time.sleep(0)

    def timeline(self, *, from_s: float, until_s: float, after_seq: int) -> Timeline:
        """Return its timeline; see `RunHistory.timeline`."""
        with self.lock:
            return self.course.timeline(from_s=from_s, until_s=until_s, after_seq=after_seq)

    def at(self, *, time_s: float | None, seq: int | None, known: int | None, lines: int) -> PastRunState | None:
        """Return the run at a time of its clock or after an event; by default after the last event.

        None if that is the state after event `known`, which the client has already.
        """
        with self.lock:
            states = self.course.states
            position = states.last_seq if seq is None else min(seq, states.last_seq)
            position = position if time_s is None else states.seq_at(time_s)
            return None if position == known else states.at(position, lines=lines)

    def values(self, *, seq: int | None, watches: Sequence[Watch] = ()) -> PastUserdata:
        """Return its userdata after an event; by default after the last event."""
        with self.lock:
            states = self.course.states
            at = states.last_seq if seq is None else min(seq, states.last_seq)
            return self.userdata.at(states, at, watches=watches)

    def measured(self, files: Sequence[Path]) -> MeasuredMarkers:
        """Return its measured markers; those of telemetry come from its recordings when it has ended.

        Raises:
            RecordingError: a recording cannot be read.
        """
        with self.lock:
            states = self.course.states
            events, has_ended = states.events(1, states.last_seq), states.now.ended or self.archived is not None
        # Without the lock: nobody waits for telemetry who does not ask for it.
        return self.measured_run.markers(events, files, has_ended=has_ended)

    def failure(self, *, is_failed: bool) -> RunFailure | None:
        """Return its failure; None if it did not fail."""
        with self.lock:
            return failure_of(self.course.states) if is_failed else None


class OpenRunCache:
    """Opens runs and keeps at most `MAX_OPEN_RUNS` of them open.

    Args:
        backend: The engine.
    """

    def __init__(self, backend: Session) -> None:
        self._backend = backend
        self._opened: OrderedDict[str, OpenRun] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def archive(self) -> Archive:
        """The past runs and recordings of the project."""
        return self._backend.archive

    def of_server(self, run_id: str) -> tuple[OpenRun, list[Event]] | None:
        """Return a run of this server and its events that are not applied yet; None if there is no such run.

        Call it on the event loop's thread; apply the events on another thread, as that may take long.
        """
        key = f"server {run_id}"
        known = self._known(key)
        after = known.course.states.last_seq if known is not None else 0
        try:
            further = self._backend.events(run_id, after=after)
        except FlexcellError:
            return None
        return known or self._entry(key, run_id, self._userdata_history(run_id)), further

    def keeps(self, run_id: str) -> bool:
        """Return whether a run of the journal is open."""
        return self._known(_journal_key(run_id)) is not None

    def of_journal(self, run_id: str, *, fresh: bool) -> OpenRun:
        """Return a run of the journal; with `fresh`, a run without an end is read again.

        Raises:
            JournalError: there is no such run, or it cannot be read.
        """
        key = _journal_key(run_id)
        known = self._known(key)
        has_ended = known is not None and known.archived is not None and known.archived.summary.status != "running"
        if known is not None and (has_ended or not fresh):
            return known
        return self._with(key, self._backend.archive.run(run_id))

    def of_recording(self, path: str) -> OpenRun:
        """Return a recording by its path in the project.

        Raises:
            RecordingError: there is no such recording, or it cannot be read.
        """
        file = self._backend.archive.recording_file(path)
        key = f"recording {path} {file.stat().st_mtime_ns}"
        return self._known(key) or self._with(key, self._backend.archive.recording(path))

    def _with(self, key: str, archived: ArchivedRun) -> OpenRun:
        plan = archived.plan
        userdata_history = UserdataHistory(lambda: plan) if plan is not None else None
        opened = OpenRun(
            course=RunHistory(archived.summary.id), userdata=UserdataCheckpoints(userdata_history), archived=archived
        )
        # Before it is in the cache, so that no reader sees a partial history.
        opened.follow(archived.events)
        with self._lock:
            self._keep(key, opened)
        return opened

    def _known(self, key: str) -> OpenRun | None:
        with self._lock:
            known = self._opened.get(key)
            if known is not None:
                self._opened.move_to_end(key)
            return known

    def _userdata_history(self, run_id: str) -> UserdataHistory | None:
        try:
            return self._backend.userdata(run_id)
        except FlexcellError:
            return None

    def _entry(self, key: str, run_id: str, userdata_history: UserdataHistory | None) -> OpenRun:
        with self._lock:
            opened = self._opened.get(key) or OpenRun(
                course=RunHistory(run_id), userdata=UserdataCheckpoints(userdata_history)
            )
            self._keep(key, opened)
            return opened

    def _keep(self, key: str, opened: OpenRun) -> None:
        self._opened[key] = opened
        self._opened.move_to_end(key)
        while len(self._opened) > MAX_OPEN_RUNS:
            self._opened.popitem(last=False)


def _journal_key(run_id: str) -> str:
    return f"journal {run_id}"

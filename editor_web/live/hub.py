"""The live stream: one hub folds the engine's events, each client gets a snapshot and then deltas.

State is last-value-wins per node and coalesced per client, log lines are a bounded ring with a
count of what fell out; a client asks anew when `after` does not fit what it has. The engine's
side only marks what is dirty and never waits for anybody.
"""

from __future__ import annotations

import asyncio
import secrets
import time
from collections import deque
from collections.abc import Callable

from editor_web.contracts.backend import Backend, RunSummaryLike, Unsubscribe
from editor_web.live.control_state import ControlLive, control_live, waiting_reason
from editor_web.live.document_watch import DocumentWatch
from editor_web.live.event_log import LogLine
from editor_web.live.live_frames import DocumentsChanged, LiveDelta, LiveSnapshot, RunOverview
from editor_web.live.robot_status import RobotStatusCache
from editor_web.live.run_state import LOG_LINES, LiveRun, NodeLive, RunStateChange
from engine.errors import FlexcellError
from engine.event import Event

KEPT_RUNS = 50


class LiveClient:
    """What one page still has to be told; `frame` takes it."""

    def __init__(self, hub: LiveHub) -> None:
        self._hub = hub
        self._watched: LiveRun | None = None
        self._sent_seq = 0
        self._snapshot_due = True
        self._nodes: dict[str, NodeLive] = {}
        self._log: deque[LogLine] = deque()
        self._dropped = 0
        self._runs: dict[str, None] = {}
        self._robots: dict[str, None] = {}
        self._documents: dict[str, str | None] = {}
        self.dirty = asyncio.Event()
        self.dirty.set()

    def watch(self, run_id: str) -> None:
        """Follow another run, or none (empty id); an unknown one shows as empty."""
        self._watched = self._hub.live_run(run_id) if run_id else None
        self._snapshot_due = True
        self.dirty.set()

    def note(self, live: LiveRun, change: RunStateChange) -> None:
        """Mark what changed; called by the hub for every event, never blocks."""
        if change.run_changed:
            self._runs[live.run_id] = None
            self.dirty.set()
        if self._watched is None or live.run_id != self._watched.run_id:
            return
        if live is not self._watched:
            # It was watched before it was known.
            self.watch(live.run_id)
            return
        self._nodes.update(change.nodes)
        self._log.append(change.line)
        if len(self._log) > LOG_LINES:
            self._log.popleft()
            self._dropped += 1
        self.dirty.set()

    def note_robot(self, name: str) -> None:
        """Mark an arm whose line is another now."""
        self._robots[name] = None
        self.dirty.set()

    def note_documents(self, changed: dict[str, str | None]) -> None:
        """Mark documents that have changed on disk."""
        self._documents |= changed
        self.dirty.set()

    def refresh(self, live: LiveRun) -> None:
        """Mark a run that was rebuilt as a whole."""
        self._runs[live.run_id] = None
        self.dirty.set()
        if self._watched is not None and live.run_id == self._watched.run_id:
            self.watch(live.run_id)

    def frame(self) -> LiveSnapshot | LiveDelta | DocumentsChanged | None:
        """Take what is due as one frame; None when nothing is."""
        if self._documents and not self._snapshot_due:
            # The rest is still due.
            told, self._documents = self._documents, {}
            return DocumentsChanged(changed=told)
        self.dirty.clear()
        if self._snapshot_due:
            made: LiveSnapshot | LiveDelta | None = self._snapshot()
        elif self._nodes or self._log or self._runs or self._robots:
            made = self._delta()
        else:
            made = None
        self._snapshot_due = False
        self._nodes, self._log, self._dropped, self._robots = {}, deque(), 0, {}
        if self._documents:
            self.dirty.set()
        # The engine tells the end of a run before it has filed it; such a run is looked at again.
        self._runs = {run_id: None for run_id in self._runs if not self._hub.is_settled(run_id)}
        if self._runs:
            self.dirty.set()
        self._sent_seq = self._watched.seq if self._watched else 0
        return made

    def _snapshot(self) -> LiveSnapshot:
        live = self._watched
        return LiveSnapshot(
            run=live.run_id if live else "",
            seq=live.seq if live else 0,
            now_s=self._hub.now_s(live),
            ticking=_ticking(live),
            runs=tuple(map(_run_line, self._hub.backend.runs())),
            nodes=dict(live.nodes) if live else {},
            log=tuple(live.log) if live else (),
            control=self._hub.control_of(live),
            robots=dict(self._hub.robots.lines),
        )

    def _delta(self) -> LiveDelta:
        live = self._watched
        return LiveDelta(
            run=live.run_id if live else "",
            after=self._sent_seq,
            seq=live.seq if live else 0,
            now_s=self._hub.now_s(live),
            ticking=_ticking(live),
            runs=tuple(_run_line(self._hub.backend.run(run_id)) for run_id in self._runs),
            nodes=self._nodes,
            log=tuple(self._log),
            dropped=self._dropped,
            control=self._hub.control_of(live),
            robots={name: self._hub.robots.lines[name] for name in self._robots},
        )


class LiveHub:
    """Folds every run's events once and tells all clients.

    Args:
        backend: The engine.
        wall_s: A steady clock, seconds.
    """

    def __init__(self, backend: Backend, *, wall_s: Callable[[], float] = time.monotonic) -> None:
        self.backend = backend
        self.epoch = secrets.token_hex(8)
        self._wall_s = wall_s
        self._runs: dict[str, LiveRun] = {}
        self._seen_at_s: dict[str, float] = {}
        self._clients: set[LiveClient] = set()
        self._unsubscribe: Unsubscribe | None = None
        self.robots = RobotStatusCache(backend, changed=self._on_robot)
        self.documents = DocumentWatch(
            backend.documents, changed=self._on_documents, wanted=lambda: bool(self._clients)
        )

    @property
    def clients(self) -> tuple[LiveClient, ...]:
        """Who is told."""
        return tuple(self._clients)

    def open(self) -> None:
        """Begin to follow the engine's events."""
        self._unsubscribe = self.backend.subscribe(self._on_event)

    def close(self) -> None:
        """Stop following."""
        if self._unsubscribe is not None:
            self._unsubscribe()
            self._unsubscribe = None

    def join(self) -> LiveClient:
        """Return a new client; `leave` ends it."""
        client = LiveClient(self)
        self._clients.add(client)
        return client

    def leave(self, client: LiveClient) -> None:
        """Forget a client."""
        self._clients.discard(client)

    def live_run(self, run_id: str) -> LiveRun:
        """Return the folded run, rebuilt from the journal where it is not at hand."""
        if run_id not in self._runs:
            live = LiveRun(run_id)
            for event in self._recorded(run_id):
                live.apply(event)
            if live.seq == 0:
                return live
            self._keep(live)
        return self._runs[run_id]

    def now_s(self, live: LiveRun | None) -> float:
        """Return the run's clock now, carried on by wall time since its last event while it ticks."""
        if live is None:
            return 0.0
        if not _ticking(live):
            return live.time_s
        return live.time_s + self._wall_s() - self._seen_at_s.get(live.run_id, self._wall_s())

    def control_of(self, live: LiveRun | None) -> ControlLive | None:
        """Return the control of a run as it is now; None when it is over or unknown."""
        if live is None or live.ended or live.seq == 0:
            return None
        view = self.backend.run(live.run_id).control
        return None if view is None else control_live(view, lock_reasons=live.lock_reasons)

    def is_settled(self, run_id: str) -> bool:
        """Say whether the backend's word on a run agrees with the run's events."""
        live = self._runs.get(run_id)
        return live is None or not live.ended or self.backend.run(run_id).status not in ("running", "stopping")

    def _on_event(self, run_id: str, event: Event) -> None:
        # A run that was under way before the hub opened is rebuilt first, this event included or not.
        live = self.live_run(run_id)
        if live.seq == 0:
            self._keep(live)
        change = live.apply(event)
        self._seen_at_s[run_id] = self._wall_s()
        if change is None:
            for client in self._clients:
                client.refresh(live)
            return
        for client in self._clients:
            client.note(live, change)

    def _on_robot(self, name: str) -> None:
        for client in self._clients:
            client.note_robot(name)

    def _on_documents(self, changed: dict[str, str | None]) -> None:
        for client in self._clients:
            client.note_documents(changed)

    def _recorded(self, run_id: str) -> list[Event]:
        try:
            return self.backend.events(run_id)
        except FlexcellError:
            # A page may ask for a run that is gone; it gets an empty one.
            return []

    def _keep(self, live: LiveRun) -> None:
        self._runs[live.run_id] = live
        over = [run_id for run_id, kept in self._runs.items() if kept.ended]
        for run_id in over[: max(0, len(self._runs) - KEPT_RUNS)]:
            if run_id != live.run_id:
                del self._runs[run_id]
                self._seen_at_s.pop(run_id, None)


def _ticking(live: LiveRun | None) -> bool:
    return live is not None and live.real_time and not live.ended


def _run_line(run: RunSummaryLike) -> RunOverview:
    return RunOverview(
        id=run.id,
        behavior=run.behavior,
        status=run.status,
        outcome=run.outcome,
        success=run.success,
        cause=run.cause,
        started_at_s=run.started_at_s,
        duration_s=run.duration_s,
        waits=waiting_reason(run.control),
    )

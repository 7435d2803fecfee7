"""The live stream: one hub reads the state of the session's runs, each client gets a snapshot and then deltas.

Node states are last-value-wins and coalesced per client; log lines are a bounded ring buffer with a count of dropped
lines; a client requests a new snapshot if `after` does not match its state. The engine's side only sets dirty marks
and never waits for a client.
"""

from __future__ import annotations

import asyncio
import secrets
import time
from collections import deque
from collections.abc import Callable

from editor_web.live.cell_stop_watch import CellStopWatch
from editor_web.live.document_watch import DocumentWatch
from editor_web.live.live_frames import (
    CellStopChanged,
    DocumentsChanged,
    LiveDelta,
    LiveSnapshot,
    StatesChanged,
    SweepsChanged,
)
from editor_web.live.presence import PresenceChanged, PresenceRoster
from editor_web.live.robot_status import RobotStatusCache
from engine.errors import ControlError, FlexcellError
from engine.project import Session
from engine.runtime.control import ControlView
from engine.runtime.history import LOG_LINES, LiveRun, LiveRunChange, LogLine, NodeLive
from engine.sweep_library import SweepLive


class LiveClient:
    """The pending changes of one page; `frame` returns and clears them."""

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
        self._sweeps: dict[str, SweepLive] = dict(hub.sweeps)
        self._is_stop_due = False
        self._is_presence_due = False
        self._are_states_due = False
        self.page = hub.presence.new_page()
        """Its number among the pages of this server."""
        self.dirty = asyncio.Event()
        self.dirty.set()

    def watch(self, run_id: str) -> None:
        """Follow another run, or none (empty id); an unknown run is empty."""
        self._watched = self._hub.live_run(run_id) if run_id else None
        self._snapshot_due = True
        self.dirty.set()

    def note(self, live: LiveRun, change: LiveRunChange) -> None:
        """Mark changes; the hub calls it for every event; never blocks."""
        if change.run_changed:
            self._runs[live.run_id] = None
            self.dirty.set()
        if self._watched is None or live.run_id != self._watched.run_id:
            return
        if live is not self._watched:
            # The page watched the run before the session knew it.
            self.watch(live.run_id)
            return
        self._nodes.update(change.nodes)
        self._log.append(change.line)
        if len(self._log) > LOG_LINES:
            self._log.popleft()
            self._dropped += 1
        self.dirty.set()

    def note_robot(self, name: str) -> None:
        """Mark an arm whose status has changed."""
        self._robots[name] = None
        self.dirty.set()

    def note_documents(self, changed: dict[str, str | None]) -> None:
        """Mark documents that have changed on disk."""
        self._documents |= changed
        self.dirty.set()

    def note_states(self) -> None:
        """Mark that modules of states were loaded anew."""
        self._are_states_due = True
        self.dirty.set()

    def note_sweep(self, sweep: str, live: SweepLive) -> None:
        """Mark a sweep that has gone on, or has ended."""
        self._sweeps[sweep] = live
        self.dirty.set()

    def note_stop(self) -> None:
        """Mark the latest stop of the cell as changed."""
        self._is_stop_due = True
        self.dirty.set()

    def note_presence(self) -> None:
        """Mark the open pages as changed."""
        self._is_presence_due = True
        self.dirty.set()

    def frame(
        self,
    ) -> (
        LiveSnapshot
        | LiveDelta
        | DocumentsChanged
        | StatesChanged
        | SweepsChanged
        | CellStopChanged
        | PresenceChanged
        | None
    ):
        """Return the pending changes as one frame and clear them; None if there are none. A stop comes first."""
        if self._is_stop_due and not self._snapshot_due:
            self._is_stop_due = False
            return CellStopChanged(stop=self._hub.stop_watch.stop)
        if self._documents and not self._snapshot_due:
            # The other changes stay pending.
            changed, self._documents = self._documents, {}
            return DocumentsChanged(changed=changed)
        if self._are_states_due and not self._snapshot_due:
            self._are_states_due = False
            return StatesChanged(revision=self._hub.states_revision)
        if self._sweeps and not self._snapshot_due:
            gone_on, self._sweeps = self._sweeps, {}
            return SweepsChanged(changed=gone_on)
        if self._is_presence_due and not self._snapshot_due:
            self._is_presence_due = False
            return PresenceChanged(page=self.page, present=self._hub.presence.present)
        self.dirty.clear()
        if self._snapshot_due:
            frame: LiveSnapshot | LiveDelta | None = self._snapshot()
        elif self._nodes or self._log or self._runs or self._robots:
            frame = self._delta()
        else:
            frame = None
        self._snapshot_due = self._is_stop_due = False
        self._nodes, self._log, self._dropped, self._robots = {}, deque(), 0, {}
        if self._documents or self._are_states_due or self._sweeps or self._is_presence_due:
            self.dirty.set()
        # The engine reports the end of a run before it has stored it; such a run is read again.
        self._runs = {run_id: None for run_id in self._runs if not self._hub.is_settled(run_id)}
        if self._runs:
            self.dirty.set()
        self._sent_seq = self._watched.state.seq if self._watched else 0
        return frame

    def _snapshot(self) -> LiveSnapshot:
        live = self._watched
        return LiveSnapshot(
            run=live.run_id if live else "",
            seq=live.state.seq if live else 0,
            now_s=self._hub.now_s(live),
            ticking=self._hub.ticking(live),
            runs=self._hub.backend.runs(),
            nodes=dict(live.state.nodes) if live else {},
            log=tuple(live.log) if live else (),
            control=self._hub.control_of(live),
            lock_reasons=dict(live.state.locks) if live else {},
            robots=dict(self._hub.robots.lines),
            stop=self._hub.stop_watch.stop,
        )

    def _delta(self) -> LiveDelta:
        live = self._watched
        return LiveDelta(
            run=live.run_id if live else "",
            after=self._sent_seq,
            seq=live.state.seq if live else 0,
            now_s=self._hub.now_s(live),
            ticking=self._hub.ticking(live),
            runs=tuple(self._hub.backend.run(run_id) for run_id in self._runs),
            nodes=self._nodes,
            log=tuple(self._log),
            dropped=self._dropped,
            control=self._hub.control_of(live),
            lock_reasons=dict(live.state.locks) if live else {},
            robots={name: self._hub.robots.lines[name] for name in self._robots},
        )


class LiveHub:
    """Tells all clients what has changed in the runs of the session.

    Args:
        backend: The engine.
        wall_s: A monotonic clock, seconds.
    """

    def __init__(self, backend: Session, *, wall_s: Callable[[], float] = time.monotonic) -> None:
        self.backend = backend
        self.epoch = secrets.token_hex(8)
        self._wall_s = wall_s
        self._seen_at_s: dict[str, float] = {}
        self._clients: set[LiveClient] = set()
        self.sweeps: dict[str, SweepLive] = {}
        """The sweeps that are being executed."""
        self._unsubscribe: Callable[[], None] | None = None
        self.presence = PresenceRoster(changed=self._on_presence, now_s=time.time)
        """Who has the page open."""
        self.robots = RobotStatusCache(backend, changed=self._on_robot)
        self.stop_watch = CellStopWatch(backend, changed=self._on_stop)
        self.documents = DocumentWatch(
            backend.documents,
            changed=self._on_documents,
            reloaded=self._on_states,
            are_used=backend.executes_classes_of,
            is_needed=lambda: bool(self._clients),
        )
        self.states_revision = 0
        """How often modules of the project's own states were loaded anew."""

    @property
    def clients(self) -> tuple[LiveClient, ...]:
        """The connected clients."""
        return tuple(self._clients)

    def open(self) -> None:
        """Subscribe to the changes of all runs, and to stops."""
        self._unsubscribe = self.backend.subscribe(self._on_change)
        self.stop_watch.open()

    def close(self) -> None:
        """Unsubscribe from the changes of the runs; `stop_watch` is closed by itself."""
        if self._unsubscribe is not None:
            self._unsubscribe()
            self._unsubscribe = None

    def join(self) -> LiveClient:
        """Return a new client; `leave` removes it."""
        client = LiveClient(self)
        self._clients.add(client)
        return client

    def leave(self, client: LiveClient) -> None:
        """Remove a client."""
        self._clients.discard(client)
        self.presence.leave(client.page)

    def _on_presence(self) -> None:
        for client in self._clients:
            client.note_presence()

    def note_sweep(self, sweep: str, live: SweepLive) -> None:
        """Tell all clients how far a sweep is."""
        self.sweeps[sweep] = live
        if live.status == "idle":
            del self.sweeps[sweep]
        for client in self._clients:
            client.note_sweep(sweep, live)

    def live_run(self, run_id: str) -> LiveRun:
        """Return a run; a page may request one that no longer exists, which is empty."""
        try:
            return self.backend.live(run_id)
        except FlexcellError:
            return LiveRun(run_id)

    def now_s(self, live: LiveRun | None) -> float:
        """Return the displayed run time: of the last event, extrapolated with wall time while it advances."""
        if live is None:
            return 0.0
        if not self.ticking(live):
            return live.state.time_s
        return live.state.time_s + self._wall_s() - self._seen_at_s.get(live.run_id, self._wall_s())

    def ticking(self, live: LiveRun | None) -> bool:
        """Return whether the displayed time of a run advances: not while it is paused, or in virtual time."""
        if live is None or not live.state.real_time or live.state.ended:
            return False
        control = self.control_of(live)
        return control is None or not control.time_stands

    def control_of(self, live: LiveRun | None) -> ControlView | None:
        """Return the current control state of a run; None if it has ended or is unknown."""
        if live is None or live.state.ended or live.state.seq == 0:
            return None
        try:
            return self.backend.control(live.run_id).view()
        except ControlError:
            # It ends just now: its last event has not come yet.
            return None

    def is_settled(self, run_id: str) -> bool:
        """Return whether the backend's status of a run agrees with the run's events."""
        return not self.live_run(run_id).state.ended or self.backend.run(run_id).status not in ("running", "stopping")

    def _on_change(self, live: LiveRun, change: LiveRunChange) -> None:
        self._seen_at_s[live.run_id] = self._wall_s()
        if live.state.ended:
            del self._seen_at_s[live.run_id]
        for client in self._clients:
            client.note(live, change)

    def _on_robot(self, name: str) -> None:
        for client in self._clients:
            client.note_robot(name)

    def _on_stop(self) -> None:
        for client in self._clients:
            client.note_stop()

    def _on_documents(self, changed: dict[str, str | None]) -> None:
        for client in self._clients:
            client.note_documents(changed)

    def _on_states(self) -> None:
        self.states_revision += 1
        for client in self._clients:
            client.note_states()

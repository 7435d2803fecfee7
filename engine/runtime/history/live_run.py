"""A run whose state is kept up to date: its events, the state that they reduce to, and the last lines of its log."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import msgspec

from engine.event import Event
from engine.runtime.history.event_log import LogLine, log_line
from engine.runtime.history.run_reducer import RunReducer
from engine.runtime.history.run_state import NodeLive, RunState

LOG_LINES = 1000


class LiveRunChange(msgspec.Struct, frozen=True, kw_only=True):
    """What one event changed: the changed nodes, the line of the log, whether its `RunView` may differ."""

    nodes: dict[str, NodeLive]
    line: LogLine
    run_changed: bool


class LiveRun:
    """One run, changed by `apply` only.

    Args:
        run_id: The id of the run.
        events: The events so far.
    """

    def __init__(self, run_id: str, events: Iterable[Event] = ()) -> None:
        self.run_id = run_id
        self.events: list[Event] = []
        self.log: deque[LogLine] = deque(maxlen=LOG_LINES)
        self._reducer = RunReducer(run_id, history=lambda: self.events)
        for event in events:
            self.apply(event)

    @property
    def state(self) -> RunState:
        """The state of the run."""
        return self._reducer.state

    @property
    def last(self) -> Event | None:
        """Its last event so far."""
        return self.events[-1] if self.events else None

    def apply(self, event: Event) -> LiveRunChange | None:
        """Apply the next event; None if it was applied before."""
        change = self._reducer.apply(event)
        if change is None:
            return None
        self.events.append(event)
        line = log_line(event, duration_s=change.duration_s)
        self.log.append(line)
        return LiveRunChange(nodes=change.nodes, line=line, run_changed=change.run_changed)

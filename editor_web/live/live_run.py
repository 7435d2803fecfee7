"""One run for the page: its reduced state, and the last lines of its log."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable

import msgspec

from editor_web.live.event_log import LogLine, log_line
from engine.event import Event
from engine.runtime.history import NodeLive, RunReducer, RunState

LOG_LINES = 1000


class LiveRunChange(msgspec.Struct, frozen=True, kw_only=True):
    """What one event changed for the page."""

    nodes: dict[str, NodeLive]
    line: LogLine
    run_changed: bool


class LiveRun:
    """One run, changed by `apply` only.

    Args:
        run_id: The id of the run.
        history: Returns all events of the run, for a resume that takes the last ones back.
    """

    def __init__(self, run_id: str, *, history: Callable[[], Iterable[Event]] = tuple[Event, ...]) -> None:
        self._reducer = RunReducer(run_id, history=history)
        self.run_id = run_id
        self.log: deque[LogLine] = deque(maxlen=LOG_LINES)

    @property
    def state(self) -> RunState:
        """The state of the run."""
        return self._reducer.state

    def apply(self, event: Event) -> LiveRunChange | None:
        """Apply one event; None if it was applied before."""
        change = self._reducer.apply(event)
        if change is None:
            return None
        line = log_line(event, duration_s=change.duration_s)
        self.log.append(line)
        return LiveRunChange(nodes=change.nodes, line=line, run_changed=change.run_changed)

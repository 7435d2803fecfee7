"""State history of a run: its events are reduced once, with checkpoints for fast access to any point in time."""

from __future__ import annotations

from bisect import bisect_right
from collections import deque
from collections.abc import Mapping, Sequence

import msgspec

from engine.event import Event
from engine.runtime.history import (
    LOG_LINES,
    LogLine,
    NodeLive,
    NodeStep,
    RunReducer,
    RunState,
    RunStateChange,
    log_line,
)

CHECKPOINT_INTERVAL = 512
"""Initial number of events between two checkpoints."""
MAX_CHECKPOINTS = 256


class PastRunState(msgspec.Struct, frozen=True, kw_only=True):
    """A run after event `seq`: its nodes and the last lines of its log; `dropped` counts the earlier lines."""

    seq: int
    time_s: float
    nodes: dict[str, NodeLive]
    log: tuple[LogLine, ...]
    dropped: int


class RunStateHistory:
    """The state history of one run; `follow` applies further events of an active run. Not thread-safe."""

    def __init__(self, run_id: str) -> None:
        self._events: list[Event] = []
        self._times_s: list[float] = []
        self._steps: dict[int, NodeStep] = {}
        self._every = CHECKPOINT_INTERVAL
        self._latest = RunReducer(run_id, history=lambda: self._events)
        self._checkpoints: list[RunReducer] = [self._latest.copy()]

    @property
    def now(self) -> RunState:
        """The run after its last event."""
        return self._latest.state

    @property
    def steps(self) -> Mapping[int, NodeStep]:
        """What the events did to nodes, by their numbers."""
        return self._steps

    @property
    def last_seq(self) -> int:
        """The number of the last event."""
        return self.now.seq

    def follow(self, event: Event) -> RunStateChange | None:
        """Apply the next event; return what it changed, None if it was applied before."""
        change = self._latest.apply(event)
        if change is None:
            return None
        self._events.append(event)
        self._times_s.append(event.time_s)
        if change.step is not None:
            self._steps[event.seq] = change.step
        if len(self._events) % self._every == 0:
            self._keep()
        return change

    def seq_at(self, time_s: float) -> int:
        """Return the number of the last event up to a time of the run's clock; 0 before the first."""
        index = bisect_right(self._times_s, time_s)
        return self._events[index - 1].seq if index else 0

    def at(self, seq: int, *, lines: int = LOG_LINES) -> PastRunState:
        """Return the run after event `seq`, with at most `lines` lines of its log."""
        count = bisect_right(self._events, seq, key=lambda event: event.seq)
        shown = min(lines, LOG_LINES)
        begin = max(0, count - shown) // self._every
        reducer = self._checkpoints[min(begin, len(self._checkpoints) - 1)].copy()
        log: deque[LogLine] = deque(maxlen=shown)
        first = bisect_right(self._events, reducer.state.seq, key=lambda event: event.seq)
        for event in self._events[first:count]:
            change = reducer.apply(event)
            if change is not None:
                log.append(log_line(event, duration_s=change.duration_s))
        state = reducer.state
        return PastRunState(
            seq=state.seq, time_s=state.time_s, nodes=state.nodes, log=tuple(log), dropped=count - len(log)
        )

    def events(self, first: int, last: int) -> Sequence[Event]:
        """Return the events from number `first` to number `last`, both included."""
        start = bisect_right(self._events, first - 1, key=lambda event: event.seq)
        end = bisect_right(self._events, last, key=lambda event: event.seq)
        return self._events[start:end]

    def _keep(self) -> None:
        self._checkpoints.append(self._latest.copy())
        if len(self._checkpoints) > MAX_CHECKPOINTS:
            # Keep every second checkpoint and double the interval.
            self._checkpoints = self._checkpoints[::2]
            self._every *= 2

"""A run of a session: its task, its events and its result."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable

from engine.event import Event
from engine.run import Run, RunResult


class SessionRun:
    """One run under way or over; used on the session's event loop.

    Args:
        behavior_id: What it executes.
        run: The run.
        started_s: The time of the cell's clock at its start.
        events: Those that it had before this session, when it was resumed.
    """

    def __init__(self, behavior_id: str, run: Run, started_s: float, *, events: Iterable[Event] = ()) -> None:
        self.behavior_id = behavior_id
        self.run = run
        self.started_s = started_s
        self.started_at_s = time.time()
        self.events: list[Event] = list(events)
        self.stopping = False
        self.result: RunResult | None = None
        self.task: asyncio.Task[None] | None = None

    def stop(self, reason: str) -> None:
        """Ask it to stop and return at once; one that is over stays as it is."""
        if self.result is None:
            self.stopping = True
            self.run.stop(reason)

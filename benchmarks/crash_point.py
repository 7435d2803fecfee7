"""Where a run is killed: at an event, or around one of its commits, really, as by `kill -9`."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Literal

from engine.errors import JournalError
from engine.event import Event
from engine.journal import JournalPort, RunJournal, RunOrigin

Moment = Literal["event", "before commit", "after commit"]


@dataclass(frozen=True, kw_only=True)
class CrashPoint:
    """The n-th event, or the n-th commit, of one engine; an event is not durable when it is reached."""

    moment: Moment
    number: int


@dataclass
class Counter:
    """Counts what an engine does, and kills its process at the crash point."""

    point: CrashPoint | None = None
    counts: dict[Moment, int] = field(default_factory=lambda: {"event": 0, "before commit": 0, "after commit": 0})

    def reached(self, moment: Moment) -> None:
        """Count, and die if this is it."""
        self.counts[moment] += 1
        if self.point is not None and (self.point.moment, self.point.number) == (moment, self.counts[moment]):
            os.kill(os.getpid(), signal.SIGKILL)


@dataclass(frozen=True)
class _CrashingRun:
    """The journal of one run, with a counter around it."""

    inner: RunJournal
    counter: Counter

    @property
    def run_id(self) -> str:
        return self.inner.run_id

    @property
    def epoch(self) -> int:
        return self.inner.epoch

    def append(self, event: Event) -> None:
        self.inner.append(event)
        self.counter.reached("event")

    async def events(self) -> Sequence[Event]:
        return await self.inner.events()

    async def apply_backpressure(self) -> None:
        await self.inner.apply_backpressure()

    def append_world_state(self, state: bytes) -> None:
        self.inner.append_world_state(state)

    def on_failure(self, listener: Callable[[JournalError], None]) -> None:
        self.inner.on_failure(listener)

    async def commit(self) -> None:
        self.counter.reached("before commit")
        await self.inner.commit()
        self.counter.reached("after commit")


@dataclass(frozen=True)
class CrashingJournal:
    """A journal whose process dies at the point of its counter."""

    inner: JournalPort
    counter: Counter

    def begin(
        self, run_id: str, *, behavior: str, document: str, started_unix_s: float, origin: RunOrigin | None = None
    ) -> RunJournal:
        entry = self.inner.begin(
            run_id, behavior=behavior, document=document, started_unix_s=started_unix_s, origin=origin
        )
        return _CrashingRun(entry, self.counter)

    def resume(self, run_id: str) -> RunJournal:
        return _CrashingRun(self.inner.resume(run_id), self.counter)

    def close(self) -> None:
        self.inner.close()

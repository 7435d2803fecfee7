"""Data of one page besides the run: metrics, one topic, plots, userdata; each is sampled only while subscribed.

Sampling adds no bus subscription and no load for publishers and the engine. A slow page loses the oldest samples; for
all other data the latest value wins.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable, Iterable

from msgspec.structs import replace

from editor_web.telemetry.bus_metrics import BusMetrics
from editor_web.telemetry.cell_state import cell_state
from editor_web.telemetry.data_frames import (
    MAX_CURVES,
    CellStateFrame,
    DataFrame,
    DataSubscription,
    GoalProgress,
    GoalsFrame,
    MessageFrame,
    SamplesFrame,
    UserdataFrame,
)
from editor_web.telemetry.goal_progress import progress_by_node
from editor_web.telemetry.plot_signals import Path, number_at, path_of
from editor_web.telemetry.truncate import truncate_value
from engine.errors import FlexcellError
from engine.project import Session
from engine.runtime.history import ScopeView, UserdataHistory, Watch, WatchValue, evaluate_watch

SAMPLE_S = 0.05
MESSAGE_S = 0.2
USERDATA_S = 0.2
GOALS_S = 0.2
CELL_S = 0.2
TRAFFIC_S = 1.0
KEPT_ROWS = 100
"""Maximum number of samples kept for a slow page: five seconds."""
_VALUE_LEAVES = 400
_NOTHING = DataSubscription()


class PageSubscriptions:
    """The subscriptions of one page; `due` returns the frames to send now.

    Args:
        backend: The engine.
        unix_s: The server's clock.
    """

    def __init__(self, backend: Session, *, unix_s: Callable[[], float] = time.time) -> None:
        self._backend = backend
        self._inspector = backend.inspector
        self._unix_s = unix_s
        self._look = _NOTHING
        self._next_s: dict[str, float] = {}
        self._meter = BusMetrics(self._inspector)
        self._curves: tuple[tuple[str, Path], ...] = ()
        self._rows: deque[tuple[float, tuple[float | None, ...]]] = deque()
        self._dropped = 0
        self._seen: dict[str, tuple[str, int]] = {}
        self._history: UserdataHistory | None = None
        self._goals: dict[str, GoalProgress] | None = None
        self._cell: CellStateFrame | None = None
        self.begun = asyncio.Event()
        """Set while the page subscribes to anything."""

    @property
    def samples(self) -> bool:
        """Whether the page plots any signal."""
        return bool(self._curves)

    def look(self, look: DataSubscription) -> None:
        """Replace the subscription."""
        before, self._look = self._look, look
        self._next_s = {}
        self._curves = tuple(_curve(field) for field in look.fields[:MAX_CURVES])
        if (look.number, look.fields) != (before.number, before.fields):
            self._rows.clear()
            self._dropped = 0
        self._seen = {}
        self._history = None
        self._goals = None
        self._cell = None
        if look.traffic or look.topic or look.fields or look.run or look.goals or look.cell:
            self.begun.set()
        else:
            self.begun.clear()

    def sample(self) -> None:
        """Sample the current values of all plots; drop the oldest row if too many are pending."""
        messages: dict[str, object] = {}
        for topic, _ in self._curves:
            if topic not in messages:
                messages[topic] = self._inspector.latest(topic)
        if len(self._rows) >= KEPT_ROWS:
            self._rows.popleft()
            self._dropped += 1
        self._rows.append((self._unix_s(), tuple(number_at(messages[topic], path) for topic, path in self._curves)))

    def due(self) -> list[DataFrame]:
        """Return the frames to send now."""
        frames: list[DataFrame] = []
        if self._rows:
            frames.append(self._samples())
        if self._look.topic and self._is_time("topic", MESSAGE_S):
            frames += self._message(self._look.topic)
        if self._look.run and self._is_time("run", USERDATA_S):
            frames += self._userdata(self._look.run)
        if self._look.goals and self._is_time("goals", GOALS_S):
            frames += self._goals_of(self._look.goals)
        if self._look.cell and self._is_time("cell", CELL_S):
            frames += self._cell_state()
        if self._look.traffic and self._is_time("traffic", TRAFFIC_S):
            frames.append(self._meter.frame())
        return frames

    def _is_time(self, what: str, period_s: float) -> bool:
        now_s = self._inspector.now_s
        if now_s < self._next_s.get(what, 0.0):
            return False
        self._next_s[what] = now_s + period_s
        return True

    def _samples(self) -> SamplesFrame:
        rows, self._rows = self._rows, deque()
        dropped, self._dropped = self._dropped, 0
        return SamplesFrame(
            number=self._look.number,
            times_s=tuple(at_s for at_s, _ in rows),
            rows=tuple(row for _, row in rows),
            dropped=dropped,
        )

    def _message(self, name: str) -> list[DataFrame]:
        try:
            topic = self._inspector.topic(name)
        except FlexcellError as error:
            return self._once("topic", (name, -1), MessageFrame(topic=name, at_s=self._unix_s(), problem=error.message))
        latest = self._inspector.latest(name)
        if latest is None:
            empty = MessageFrame(topic=name, at_s=self._unix_s(), problem="no message was published on this topic yet")
            return self._once("topic", (name, 0), empty)
        if not topic.is_made_on_demand and self._seen.get("topic") == (name, topic.count):
            return []
        self._seen["topic"] = (name, topic.count)
        return [MessageFrame(topic=name, at_s=self._unix_s(), value=truncate_value(latest))]

    def _once(self, what: str, seen: tuple[str, int], frame: DataFrame) -> list[DataFrame]:
        if self._seen.get(what) == seen:
            return []
        self._seen[what] = seen
        return [frame]

    def _userdata(self, run: str) -> list[DataFrame]:
        first = self._history is None
        try:
            userdata = self._history = self._history or self._backend.userdata(run)
            userdata.read(self._backend.events(run, after=userdata.seq))
        except FlexcellError as error:
            return self._once("run", (run, -1), UserdataFrame(run=run, first=True, scopes={}, problem=error.message))
        changes = userdata.changes()
        if not changes and not first:
            return []
        scopes = {path: userdata_scope(scope) if scope is not None else None for path, scope in changes.items()}
        watches = watch_values(self._look.watches, userdata)
        return [UserdataFrame(run=run, first=first, scopes=scopes, watches=watches)]

    def _goals_of(self, run: str) -> list[DataFrame]:
        before, self._goals = self._goals, progress_by_node(self._inspector.goals(run))
        return [] if self._goals == before else [GoalsFrame(run=run, goals=self._goals)]

    def _cell_state(self) -> list[DataFrame]:
        before, self._cell = self._cell, cell_state(self._inspector)
        return [] if self._cell == before else [self._cell]


def _curve(field: str) -> tuple[str, Path]:
    topic, _, path = field.rpartition(":")
    return topic, path_of(path)


def watch_values(watches: Iterable[Watch], userdata: UserdataHistory) -> tuple[WatchValue, ...]:
    """Return the values of watches for a page, large ones truncated."""
    found = (evaluate_watch(each, userdata) for each in watches)
    return tuple(replace(each, value=truncate_value(each.value, max_leaves=_VALUE_LEAVES)) for each in found)


def userdata_scope(scope: ScopeView) -> ScopeView:
    """Return the values of a container for a page, large ones truncated."""
    values = {
        key: replace(entry, value=truncate_value(entry.value, max_leaves=_VALUE_LEAVES))
        for key, entry in scope.values.items()
    }
    return replace(scope, values=values)

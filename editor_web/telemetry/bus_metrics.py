"""Rates, ages, leases and goals of a bus, from periodic samples of its counters."""

from __future__ import annotations

import zlib
from collections import deque

from msgspec.structs import replace

from editor_web.telemetry.data_frames import BusMetricsFrame, LeaseMetrics, TopicMetrics
from engine.bus import Lease
from engine.project import BusInspector, GoalInfo, TopicStatistics

WINDOW_S = 4.0


class BusMetrics:
    """Computes metrics between its own samples, at no cost for publishers."""

    def __init__(self, inspector: BusInspector) -> None:
        self._inspector = inspector
        self._samples: deque[tuple[float, dict[str, TopicStatistics]]] = deque()

    def frame(self) -> BusMetricsFrame:
        """Take a sample and return the metrics."""
        now_s, traffic = self._inspector.now_s, self._inspector.traffic()
        while len(self._samples) > 1 and now_s - self._samples[0][0] > WINDOW_S:
            self._samples.popleft()
        then_s, then = self._samples[0] if self._samples else (now_s, {})
        self._samples.append((now_s, traffic))
        goals = self._inspector.goals()
        return BusMetricsFrame(
            shape=bus_fingerprint(self._inspector),
            topics={
                name: _line(each, then.get(name), now_s=now_s, then_s=then_s) for name, each in sorted(traffic.items())
            },
            leases=tuple(_lease(each, goals, now_s) for each in self._inspector.leases()),
            # What a goal feeds back may be large, and is shown where the goal was sent.
            goals=tuple(replace(goal, feedback=None) for goal in goals),
        )


def bus_fingerprint(inspector: BusInspector) -> str:
    """Return a checksum of the topics, skills, parameters and parameter values."""
    return f"{zlib.crc32(chr(10).join(inspector.shape()).encode()):08x}"


def _line(now: TopicStatistics, then: TopicStatistics | None, *, now_s: float, then_s: float) -> TopicMetrics:
    counted = now.count - then.count if then is not None else 0
    return TopicMetrics(
        rate_hz=counted / (now_s - then_s) if now_s > then_s else 0.0,
        age_s=max(0.0, now_s - now.latest_at_s) if now.latest_at_s is not None else None,
        on_demand=now.on_demand,
        subscribers=now.subscribers,
    )


def _lease(lease: Lease, goals: tuple[GoalInfo, ...], now_s: float) -> LeaseMetrics:
    mine = (
        goal.id
        for goal in goals
        if (goal.run, goal.node) == (lease.run, lease.branch) and goal.address.rpartition("/")[0] == lease.resource
    )
    return LeaseMetrics(
        resource=lease.resource,
        run=lease.run,
        node=lease.branch,
        goal=next(mine, ""),
        held_s=max(0.0, now_s - lease.since_s),
    )

"""One measurement inside a worker process: how much was done, in how much CPU and wall time."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Sample:
    """`units` of work done in `cpu_s` of all threads and `wall_s`; latencies where single events were timed."""

    units: int
    cpu_s: float
    wall_s: float
    latencies_s: tuple[float, ...] = ()


@dataclass(frozen=True)
class Stopwatch:
    """Repeats a piece of work until it has used `at_least_s` of CPU, after one round that is not counted."""

    at_least_s: float

    def measure(self, units: int, work: Callable[[], object]) -> Sample:
        """Time plain work that does `units` each time it is called."""
        work()
        rounds, cpu_s, wall_s = 0, time.process_time(), time.perf_counter()
        while rounds == 0 or time.process_time() - cpu_s < self.at_least_s:
            work()
            rounds += 1
        return Sample(units * rounds, time.process_time() - cpu_s, time.perf_counter() - wall_s)

    async def measure_async(self, units: int, work: Callable[[], Awaitable[object]]) -> Sample:
        """Time work on the running event loop that does `units` each time it is awaited."""
        await work()
        rounds, cpu_s, wall_s = 0, time.process_time(), time.perf_counter()
        while rounds == 0 or time.process_time() - cpu_s < self.at_least_s:
            await work()
            rounds += 1
        return Sample(units * rounds, time.process_time() - cpu_s, time.perf_counter() - wall_s)


class Reactions:
    """Posts events from a thread of its own, each once the engine waits, and times the reactions.

    The engine calls `waiting` when it has begun to wait and `entered` in the state after. Events
    come at random times within `spread_s`, which must cover the period of an engine that polls.
    """

    def __init__(self, events: int, post: Callable[[], None], *, spread_s: float = 0.01) -> None:
        self._due = events
        self._post = post
        self._spread_s = spread_s
        self._waiting = threading.Semaphore(0)
        self._posted_s = 0.0
        self._latencies_s: list[float] = []
        self._started = (time.process_time(), time.perf_counter())
        self._thread = threading.Thread(target=self._send, name="sender", daemon=True)
        self._thread.start()

    def waiting(self) -> None:
        """Say that the next event may come."""
        self._waiting.release()

    def entered(self) -> bool:
        """Take the time of the reaction; returns True when it was the last."""
        self._latencies_s.append(time.perf_counter() - self._posted_s)
        return len(self._latencies_s) >= self._due

    def sample(self) -> Sample:
        """Return all reactions."""
        self._thread.join()
        cpu_s, wall_s = self._started
        latencies_s = tuple(self._latencies_s)
        return Sample(len(latencies_s), time.process_time() - cpu_s, time.perf_counter() - wall_s, latencies_s)

    def _send(self) -> None:
        # Times of posting need not repeat from run to run; only their spread matters.
        random_times = random.Random(1)
        for _ in range(self._due):
            self._waiting.acquire()
            time.sleep(0.002 + random_times.random() * self._spread_s)
            self._posted_s = time.perf_counter()
            self._post()

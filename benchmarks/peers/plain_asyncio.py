"""The floor: the same work as bare coroutines, without documents, events, data or failure handling."""

from __future__ import annotations

import asyncio
import time

from benchmarks.sample import Reactions, Sample, Stopwatch


async def _step() -> str:
    return "done"


async def _chain(states: int) -> None:
    for _ in range(states):
        await _step()


async def _tick(times: int) -> None:
    for _ in range(times):
        await asyncio.sleep(0)


def chain(watch: Stopwatch, states: int) -> Sample:
    """Await one coroutine after another."""
    return asyncio.run(watch.measure_async(states, lambda: _chain(states)))


def branches(watch: Stopwatch, count: int, states: int) -> Sample:
    """A task for each chain."""

    async def work() -> None:
        await asyncio.gather(*(_chain(states) for _ in range(count)))

    return asyncio.run(watch.measure_async(count * states, work))


def ticks(watch: Stopwatch, children: int, times: int) -> Sample:
    """A task for each child that is woken again and again."""

    async def work() -> None:
        await asyncio.gather(*(_tick(times) for _ in range(children)))

    return asyncio.run(watch.measure_async(children * times, work))


def reaction(watch: Stopwatch, events: int) -> Sample:
    """Set an asyncio event from another thread."""

    async def main() -> Sample:
        loop, event = asyncio.get_running_loop(), asyncio.Event()
        reactions = Reactions(events, lambda: loop.call_soon_threadsafe(event.set) and None)
        done = False
        while not done:
            event.clear()
            reactions.waiting()
            await event.wait()
            done = reactions.entered()
        return reactions.sample()

    return asyncio.run(main())


def idle(watch: Stopwatch, children: int, duration_ms: int) -> Sample:
    """Tasks that wait for an event that does not come."""

    async def main() -> Sample:
        event = asyncio.Event()
        tasks = [asyncio.create_task(event.wait()) for _ in range(children)]
        await asyncio.sleep(0.2)
        cpu_s, wall_s = time.process_time(), time.perf_counter()
        await asyncio.sleep(duration_ms / 1000)
        sample = Sample(1, time.process_time() - cpu_s, time.perf_counter() - wall_s)
        event.set()
        await asyncio.gather(*tasks)
        return sample

    return asyncio.run(main())

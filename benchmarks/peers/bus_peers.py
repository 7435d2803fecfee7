"""Other ways to hand messages on inside a process: plain calls, asyncio queues, blinker signals, pyee events."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Any

from benchmarks.peers.joint_states import new_joint_state
from benchmarks.sample import Reactions, Sample, Stopwatch
from engine.messages import JointState

_MANY = 1000


class _Last:
    """A subscriber that keeps the last message."""

    def __init__(self) -> None:
        self._kept: deque[JointState] = deque(maxlen=1)

    def take(self, message: JointState) -> None:
        self._kept.append(message)

    def take_signal(self, sender: object, *, message: JointState) -> None:
        self._kept.append(message)


def plain_calls(watch: Stopwatch, subscribers: int) -> Sample:
    """Call each subscriber from a list."""
    taking = [_Last().take for _ in range(subscribers)]

    def publish(message: JointState) -> None:
        for take in taking:
            take(message)

    return _same(watch, publish)


def plain_calls_new(watch: Stopwatch, subscribers: int) -> Sample:
    """Make a new message each time and call each subscriber."""
    taking = [_Last().take for _ in range(subscribers)]

    def work() -> None:
        for tick in range(_MANY):
            message = new_joint_state(tick)
            for take in taking:
                take(message)

    return watch.measure(_MANY, work)


def blinker(watch: Stopwatch, subscribers: int) -> Sample:
    """A blinker signal with strong references."""
    from blinker import Signal

    signal = Signal()
    for _ in range(subscribers):
        signal.connect(_Last().take_signal, weak=False)
    return _same(watch, lambda message: signal.send(None, message=message))


def pyee(watch: Stopwatch, subscribers: int) -> Sample:
    """A pyee event."""
    from pyee import EventEmitter

    emitter = EventEmitter()
    for _ in range(subscribers):
        emitter.on("joint_states", _Last().take)
    return _same(watch, lambda message: emitter.emit("joint_states", message))


def queues(watch: Stopwatch, subscribers: int) -> Sample:
    """An asyncio.Queue for each task that awaits messages."""

    async def main() -> Sample:
        message = new_joint_state(0)

        async def read(queue: asyncio.Queue[JointState]) -> None:
            for _ in range(_MANY):
                await queue.get()

        async def work() -> None:
            channels: list[asyncio.Queue[JointState]] = [asyncio.Queue() for _ in range(subscribers)]
            readers = [asyncio.create_task(read(queue)) for queue in channels]
            await asyncio.sleep(0)
            for _ in range(_MANY):
                for queue in channels:
                    queue.put_nowait(message)
                await asyncio.sleep(0)
            await asyncio.gather(*readers)

        return await watch.measure_async(_MANY, work)

    return asyncio.run(main())


def attribute(watch: Stopwatch) -> Sample:
    """Read a value by name from a dictionary."""
    values = {"left/joint_states": new_joint_state(0)}

    def work() -> None:
        for _ in range(_MANY):
            values["left/joint_states"]

    return watch.measure(_MANY, work)


def coroutine(watch: Stopwatch) -> Sample:
    """Await a method of an object that one holds."""

    async def read() -> int:
        return 1

    async def work() -> None:
        for _ in range(_MANY):
            await read()

    return asyncio.run(watch.measure_async(_MANY, work))


def task(watch: Stopwatch) -> Sample:
    """Start a task and await it: what an action costs at least, as it can be cancelled and watched."""

    async def move() -> int:
        return 1

    async def work() -> None:
        for _ in range(_MANY):
            await asyncio.create_task(move())

    return asyncio.run(watch.measure_async(_MANY, work))


def lock(watch: Stopwatch) -> Sample:
    """Take and release two asyncio locks."""
    first, second = asyncio.Lock(), asyncio.Lock()

    async def work() -> None:
        for _ in range(_MANY):
            async with first, second:
                pass

    return asyncio.run(watch.measure_async(_MANY, work))


def across_threads(watch: Stopwatch, events: int) -> Sample:
    """Put into an asyncio.Queue from another thread; a task that awaits it gets the message."""

    async def main() -> Sample:
        loop, message = asyncio.get_running_loop(), new_joint_state(0)
        queue: asyncio.Queue[JointState] = asyncio.Queue()

        def post() -> None:
            loop.call_soon_threadsafe(queue.put_nowait, message)

        reactions = Reactions(events, post)
        done = False
        while not done:
            reactions.waiting()
            await queue.get()
            done = reactions.entered()
        return reactions.sample()

    return asyncio.run(main())


def _same(watch: Stopwatch, publish: Callable[[JointState], Any]) -> Sample:
    message = new_joint_state(0)

    def work() -> None:
        for _ in range(_MANY):
            publish(message)

    return watch.measure(_MANY, work)

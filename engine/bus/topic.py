"""A topic: a typed latest value and the stream of its changes.

`publish` calls the subscribers directly on the loop thread; a subscriber that awaits messages
uses `stream`. A failing subscriber is logged and removed; the publisher is not affected.
"""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import AsyncIterator, Callable
from typing import Generic, Self, TypeVar

from engine.clock import Clock
from engine.errors import BusError

M = TypeVar("M")
_log = logging.getLogger("flexcell.bus")


class Subscription(Generic[M]):
    """One subscriber; `close` ends it and may be called more than once."""

    def __init__(self, topic: Topic[M], callback: Callable[[M], None], *, asks: bool = True) -> None:
        self._topic = topic
        self.callback = callback
        self.asks = asks
        """Whether publishers build messages for this subscriber."""

    def close(self) -> None:
        """Stop receiving messages."""
        self._topic.remove(self)


class TopicStream(Generic[M]):
    """The messages since the stream was opened, for `async for`; keeps at most `size`, dropping the oldest."""

    def __init__(self, topic: Topic[M], size: int) -> None:
        self._waiting: deque[M] = deque(maxlen=size)
        self._arrived = asyncio.Event()
        self.dropped = 0
        self._subscription = topic.subscribe(self._take)

    def _take(self, message: M) -> None:
        if len(self._waiting) == self._waiting.maxlen:
            self.dropped += 1
        self._waiting.append(message)
        self._arrived.set()

    async def next(self) -> M:
        """Wait for the next message."""
        while not self._waiting:
            self._arrived.clear()
            await self._arrived.wait()
        return self._waiting.popleft()

    async def __aiter__(self) -> AsyncIterator[M]:
        while True:
            yield await self.next()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Stop receiving messages."""
        self._subscription.close()


class Topic(Generic[M]):
    """A named channel of one message type."""

    def __init__(self, name: str, kind: type[M], clock: Clock) -> None:
        self.name = name
        self.kind = kind
        self.count = 0
        self.takes_commands = False
        """Whether users may publish on it: its messages are executed, or the cell document opens it to all."""
        self._clock = clock
        self._problem: Callable[[M], str | None] | None = None
        self._latest: M | None = None
        self._provider: Callable[[], M] | None = None
        self._subscriptions: tuple[Subscription[M], ...] = ()
        self._stamps_s: deque[float] = deque(maxlen=64)

    @property
    def latest(self) -> M | None:
        """The latest message, or the message that the provider makes now; None before the first."""
        return self._provider() if self._provider is not None else self._latest

    @property
    def latest_at_s(self) -> float | None:
        """Time of the latest message on the bus's clock; None before the first."""
        return self._stamps_s[-1] if self._stamps_s else None

    @property
    def is_made_on_demand(self) -> bool:
        """Whether a provider makes the latest message when it is read."""
        return self._provider is not None

    @property
    def subscriber_count(self) -> int:
        """Number of active subscribers; at 0 a publisher may skip building messages."""
        return sum(each.asks for each in self._subscriptions)

    @property
    def rate_hz(self) -> float:
        """Mean rate over the last messages, 0 when there were fewer than two."""
        if len(self._stamps_s) < 2 or self._stamps_s[-1] == self._stamps_s[0]:
            return 0.0
        return (len(self._stamps_s) - 1) / (self._stamps_s[-1] - self._stamps_s[0])

    def provide(self, provider: Callable[[], M]) -> None:
        """Make `latest` on demand, for publishers that skip unread messages."""
        self._provider = provider

    def publish(self, message: M) -> None:
        """Store `message` as the latest and pass it to every subscriber.

        Raises:
            BusError: the message is not of the topic's type, or of what the topic is open for.
        """
        if not isinstance(message, self.kind):
            raise BusError(
                f"a {type(message).__name__} was published where {self.kind.__name__} is expected", where=self.name
            )
        if self._problem is not None and (problem := self._problem(message)) is not None:
            raise BusError(problem, where=self.name)
        self._latest = message
        self.count += 1
        self._stamps_s.append(self._clock.now_s())
        for subscription in self._subscriptions:
            try:
                subscription.callback(message)
            except Exception:
                # A subscriber may raise anything; the publisher, often a robot, must continue.
                _log.exception("a subscriber of %s failed and was removed", self.name)
                subscription.close()

    def subscribe(self, callback: Callable[[M], None]) -> Subscription[M]:
        """Call `callback` on the loop thread with each new message until closed."""
        subscription = Subscription(self, callback)
        self._subscriptions = (*self._subscriptions, subscription)
        return subscription

    def subscribe_passively(self, callback: Callable[[M], None]) -> Subscription[M]:
        """Call `callback` on the loop thread with published messages; publishers build none for it."""
        subscription = Subscription(self, callback, asks=False)
        self._subscriptions = (*self._subscriptions, subscription)
        return subscription

    def subscribe_commands(self, callback: Callable[[M], None]) -> Subscription[M]:
        """Subscribe as the server that executes the messages; users may publish on such a topic."""
        self.takes_commands = True
        return self.subscribe(callback)

    def open_to_all(self, problem: Callable[[M], str | None]) -> None:
        """Let users and behaviors publish on this topic; `problem` returns what is wrong with a message."""
        self.takes_commands = True
        self._problem = problem

    def remove(self, subscription: Subscription[M]) -> None:
        """Remove a subscriber; unknown ones are ignored."""
        self._subscriptions = tuple(s for s in self._subscriptions if s is not subscription)

    def stream(self, *, size: int = 1000) -> TopicStream[M]:
        """Return an awaitable stream of the messages from now on; `size=1` conflates."""
        return TopicStream(self, size)

"""The bus for users and other processes: access by name, with JSON in and out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from typing import Any, Protocol

import msgspec

from engine.bus.action import GoalHandle
from engine.bus.bus import BusEntry, SkillBus
from engine.bus.lease import Holder
from engine.bus.plain_requests import publish_command, typed_action, typed_service
from engine.skills.goal_end import GoalEnd

CLI_HOLDER = Holder("cli")


class JsonBus(Protocol):
    """The interface that `flexcell bus` uses, for a bus in this process or behind a server."""

    async def listing(self) -> tuple[BusEntry, ...]:
        """Return everything on the bus."""
        ...

    def echo(self, topic: str) -> AsyncGenerator[str, None]:
        """Yield the messages of a topic as JSON, first the latest one; raises BusError when there is no such topic."""
        ...

    async def publish(self, topic: str, message: object) -> None:
        """Publish a message on a command topic; raises BusError for other topics and for an invalid message."""
        ...

    async def call(self, address: str, request: object) -> str:
        """Call a service and return its response as JSON."""
        ...

    async def perform(
        self, address: str, goal: object, *, on_sent: Callable[[GoalHandle[Any, Any]], None] | None = None
    ) -> GoalEnd[Any]:
        """Send a goal and wait for its end; on cancellation, cancel the goal and wait for its end first.

        `on_sent` receives the goal once it is sent; it is not called by a bus behind a server, which tells of the end
        only.
        """
        ...


class LocalJsonBus:
    """A bus in this process."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus

    async def listing(self) -> tuple[BusEntry, ...]:
        """Return everything on the bus."""
        return self._bus.listing()

    async def echo(self, topic: str) -> AsyncGenerator[str, None]:
        """Yield the messages of a topic as JSON, first the latest one."""
        source = self._bus.find_topic(topic)
        with source.stream() as stream:
            if source.latest is not None:
                yield _text(source.latest)
            while True:
                yield _text(await stream.next())

    async def publish(self, topic: str, message: object) -> None:
        """Publish a message on a topic that takes commands.

        Raises:
            BusError: there is no such topic, it takes no commands, or the message is invalid.
        """
        publish_command(self._bus, topic, message)

    async def call(self, address: str, request: object) -> str:
        """Call a service and return its response as JSON.

        Raises:
            BusError: there is no such service, it is an action, the request is invalid, or the call failed.
        """
        namespace, _, _ = address.rpartition("/")
        typed = typed_service(self._bus, address, request)
        return _text(await self._bus.call(typed, to=namespace, holder=CLI_HOLDER))

    async def perform(
        self, address: str, goal: object, *, on_sent: Callable[[GoalHandle[Any, Any]], None] | None = None
    ) -> GoalEnd[Any]:
        """Send a goal and wait for its end.

        Raises:
            BusError: no such action, a service, an invalid goal, or a resource held by a run.
        """
        handle = self.send(address, goal)
        if on_sent is not None:
            on_sent(handle)
        return await self.ended(handle)

    def send(self, address: str, goal: object) -> GoalHandle[Any, Any]:
        """Send a goal; then await `ended`. Raises as `perform` does."""
        namespace, _, _ = address.rpartition("/")
        typed = typed_action(self._bus, address, goal)
        return self._bus.send_goal(typed, to=namespace, holder=CLI_HOLDER)

    async def ended(self, handle: GoalHandle[Any, Any]) -> GoalEnd[Any]:
        """Wait for the end of a sent goal; on cancellation, cancel the goal and wait for its end first."""
        try:
            return await handle.result()
        except asyncio.CancelledError:
            handle.cancel()
            await handle.result()
            raise
        finally:
            if not any(other is not handle for other in self._bus.goals(CLI_HOLDER.run)):
                self._bus.leases.release_run(CLI_HOLDER.run)


def _text(message: Any) -> str:
    return msgspec.json.encode(message).decode()

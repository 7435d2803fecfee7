"""The bus as people and other processes reach it: by name, with JSON in and out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from typing import Any, Protocol

import msgspec

from engine.bus.action import GoalEnd, GoalHandle
from engine.bus.bus import BusEntry, SkillBus
from engine.bus.lease import Holder
from engine.errors import BusError
from engine.skill import Action, Service

CLI_HOLDER = Holder("cli")


class JsonBus(Protocol):
    """What `flexcell bus` needs, of a bus in this process or behind a server."""

    async def listing(self) -> tuple[BusEntry, ...]:
        """Return everything on the bus."""
        ...

    def echo(self, topic: str) -> AsyncGenerator[str, None]:
        """Go through the messages of a topic as JSON, the latest one first; raises BusError when there is none."""
        ...

    async def publish(self, topic: str, message: object) -> None:
        """Publish a message on a topic that takes commands; raises BusError when it takes none, or not this one."""
        ...

    async def call(self, address: str, request: object) -> str:
        """Ask a service; returns its answer as JSON."""
        ...

    async def perform(self, address: str, goal: object) -> GoalEnd[Any]:
        """Send a goal and wait for its end; cancelled, the goal is cancelled and awaited first."""
        ...


class LocalJsonBus:
    """A bus in this process."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus

    async def listing(self) -> tuple[BusEntry, ...]:
        """Return everything on the bus."""
        return self._bus.listing()

    async def echo(self, topic: str) -> AsyncGenerator[str, None]:
        """Go through the messages of a topic as JSON, the latest one first."""
        found = self._bus.find_topic(topic)
        with found.stream() as stream:
            if found.latest is not None:
                yield _text(found.latest)
            while True:
                yield _text(await stream.next())

    async def publish(self, topic: str, message: object) -> None:
        """Publish a message on a topic that takes commands.

        Raises:
            BusError: there is no such topic, it takes no commands, or the message does not fit.
        """
        found = self._bus.find_topic(topic)
        if not found.takes_commands:
            open_to_all = self._bus.command_topics()
            raise BusError(
                "this topic takes no commands",
                where=topic,
                hint=f"commands are taken on {', '.join(open_to_all)}"
                if open_to_all
                else "nothing here takes commands",
            )
        try:
            typed = msgspec.convert(message, found.kind)
        except msgspec.ValidationError as error:
            raise BusError(f"this is not a {found.kind.__name__}: {error}", where=topic) from error
        found.publish(typed)

    async def call(self, address: str, request: object) -> str:
        """Ask a service; returns its answer as JSON.

        Raises:
            BusError: there is no such service, it is an action, the request does not fit, or it failed.
        """
        namespace, _, _ = address.rpartition("/")
        typed = self._typed(address, request)
        if not issubclass(self._bus.request_type(address), Service):
            raise BusError("this is an action, not a service", where=address, hint="use `flexcell bus goal`")
        return _text(await self._bus.call(typed, to=namespace, holder=CLI_HOLDER))

    async def perform(self, address: str, goal: object) -> GoalEnd[Any]:
        """Send a goal and wait for its end.

        Raises:
            BusError: there is no such action, it is a service, the goal does not fit, or a run holds the resource.
        """
        return await self.ended(self.send(address, goal))

    def send(self, address: str, goal: object) -> GoalHandle[Any, Any]:
        """Send a goal, to be followed by `ended`; raises what `perform` raises."""
        namespace, _, _ = address.rpartition("/")
        typed = self._typed(address, goal)
        if not issubclass(self._bus.request_type(address), Action):
            raise BusError("this is a service, not an action", where=address, hint="use `flexcell bus call`")
        return self._bus.send_goal(typed, to=namespace, holder=CLI_HOLDER)

    async def ended(self, handle: GoalHandle[Any, Any]) -> GoalEnd[Any]:
        """Wait for the end of a goal that was sent; cancelled, the goal is cancelled and awaited first."""
        try:
            return await handle.result()
        except asyncio.CancelledError:
            handle.cancel()
            await handle.result()
            raise
        finally:
            if not any(other is not handle for other in self._bus.goals(CLI_HOLDER.run)):
                self._bus.leases.release_run(CLI_HOLDER.run)

    def _typed(self, address: str, request: object) -> Any:
        skill = self._bus.request_type(address)
        try:
            return msgspec.convert(request, skill)
        except msgspec.ValidationError as error:
            raise BusError(f"this is not a {skill.__name__}: {error}", where=address) from error


def _text(message: Any) -> str:
    return msgspec.json.encode(message).decode()

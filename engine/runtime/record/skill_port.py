"""Port of a run to services, goals and topics: the skill bus, or a substitute for it.

Every request of a state passes this port, so a recording can replace robots and faults can be injected transparently
to states and bus.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar, runtime_checkable

import msgspec

from engine.bus import GoalEnd, Holder, SkillBus, publish_value, typed_action, typed_service
from engine.runtime.record.recorder import Recorder
from engine.skill import Action, NamedAction, NamedService, Service

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)


class Goal(Protocol):
    """A goal that was sent; the handle of the bus is one."""

    @property
    def finished(self) -> bool:
        """True once it has ended."""
        ...

    async def result(self) -> GoalEnd[Any]:
        """Wait for the end; cancelling this wait does not cancel the goal."""
        ...

    def cancel(self) -> None:
        """Request the cancellation; `result` returns when the device is at rest."""
        ...

    async def hold(self) -> None:
        """Bring the device to rest and keep the goal; raises BusError where the skill cannot be held."""
        ...

    async def resume(self) -> None:
        """Resume a held goal."""
        ...


class EntrySchedule(Protocol):
    """Recorded node entries of a replayed run; they replace observations."""

    def expect(self, path: str, visit: int, wake: Callable[[], None]) -> Callable[[], None]:
        """Call `wake` when visit `visit` of the node at `path` is due; returns a function that cancels this."""
        ...


class SkillPort(Protocol):
    """Requests of a run to its cell; `holder.branch` is the path of the requesting state."""

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        """Call a service; raises the errors of the bus."""
        ...

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        """Send a goal; raises the errors of the bus."""
        ...

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the latest message of a topic, waiting for the first one."""
        ...

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Wait for the next message of a topic."""
        ...

    async def latest_data(self, topic: str, *, holder: Holder) -> object:
        """Return the latest message of an existing topic as plain data, waiting for the first one."""
        ...

    async def next_data(self, topic: str, condition: Callable[[object], bool], *, holder: Holder) -> object:
        """Wait for the next message of an existing topic, as plain data, that meets the condition."""
        ...

    def publish(self, topic: str, message: object, *, holder: Holder) -> None:
        """Publish plain data on a topic that the cell document declares; raises the errors of the bus."""
        ...

    def watch(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call back at each new message of a topic that was read; returns a function that ends the subscription."""
        ...

    @property
    def entries(self) -> EntrySchedule | None:
        """The node entries of the recording that replaces the cell; None where the cell is live."""
        ...


@runtime_checkable
class RunAwarePort(Protocol):
    """A port that also writes into the event log of its run."""

    def begin(self, recorder: Recorder) -> None:
        """Receive the event log; called before the first event."""
        ...

    def end(self) -> None:
        """Write remaining events; called when all states have exited, before the end of the run is recorded."""
        ...


class BusPort:
    """The bus itself."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        """Call a service; raises the errors of the bus."""
        if isinstance(request, NamedService):
            typed = typed_service(self._bus, request.address(to), request.fields)
            return msgspec.to_builtins(await self._bus.call(typed, to=to, holder=holder))
        return await self._bus.call(request, to=to, holder=holder)

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        """Send a goal; raises the errors of the bus."""
        sent = typed_action(self._bus, goal.address(to), goal.fields) if isinstance(goal, NamedAction) else goal
        return self._bus.send_goal(sent, to=to, holder=holder, goal_id=goal_id)

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the latest message of a topic, waiting for the first one."""
        message = self._bus.topic(topic, kind).latest
        return message if message is not None else await self.next_message(topic, kind, holder=holder)

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Wait for the next message of a topic."""
        with self._bus.topic(topic, kind).stream(size=1) as stream:
            return await stream.next()

    async def latest_data(self, topic: str, *, holder: Holder) -> object:
        """Return the latest message of an existing topic as plain data, waiting for the first one."""
        message = self._bus.find_topic(topic).latest
        return (
            msgspec.to_builtins(message)
            if message is not None
            else await self.next_data(topic, every_message, holder=holder)
        )

    async def next_data(self, topic: str, condition: Callable[[object], bool], *, holder: Holder) -> object:
        """Wait for the next message of an existing topic, as plain data, that meets the condition."""
        with self._bus.find_topic(topic).stream() as stream:
            while True:
                data: object = msgspec.to_builtins(await stream.next())
                if condition(data):
                    return data

    def publish(self, topic: str, message: object, *, holder: Holder) -> None:
        """Publish plain data on a topic that the cell document declares; raises the errors of the bus."""
        publish_value(self._bus, topic, message)

    def watch(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call back at each new message of a topic that was read; returns a function that ends the subscription."""
        return self._bus.find_topic(topic).subscribe(lambda _: callback()).close

    @property
    def entries(self) -> EntrySchedule | None:
        """None: entries of a live run are not known in advance."""
        return None


def every_message(_data: object) -> bool:
    """Return True: the condition that every message meets."""
    return True

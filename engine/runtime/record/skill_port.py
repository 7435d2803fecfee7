"""How a run reaches the outside: services, goals and topics, on the bus or on what stands in for it.

Every request of a state passes here, so a recording can stand in for robots and a fault can be
injected, without the states or the bus knowing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar, runtime_checkable

import msgspec

from engine.bus import GoalEnd, Holder, SkillBus
from engine.runtime.record.recorder import Recorder
from engine.skill import Action, Service

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
        """Ask for the stop; `result` tells when the device rests."""
        ...

    async def hold(self) -> None:
        """Bring the device to rest and keep the goal; raises BusError where that cannot be."""
        ...

    async def resume(self) -> None:
        """Let a held goal go on."""
        ...


class EntrySchedule(Protocol):
    """Of a run that is told again: when each node is entered is known, so nobody has to observe anything for it."""

    def expect(self, path: str, visit: int, wake: Callable[[], None]) -> Callable[[], None]:
        """Call `wake` when the node at `path` is due to be entered the `visit`-th time; returns what forgets that."""
        ...


class SkillPort(Protocol):
    """What a run asks of its surroundings; `holder.branch` is the path of the state that asks."""

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        """Ask a service; raises what the bus raises."""
        ...

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        """Send a goal; raises what the bus raises."""
        ...

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the newest message of a topic, waiting for the first one."""
        ...

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Wait for the next message of a topic."""
        ...

    def watch(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call back at each new message of a topic that was read; returns what ends it."""
        ...

    @property
    def entries(self) -> EntrySchedule | None:
        """Those of the recording that stands in for the cell; None where nothing does."""
        ...


@runtime_checkable
class RunAwarePort(Protocol):
    """A port that also writes into the event log of the run it is given to."""

    def begin(self, recorder: Recorder) -> None:
        """Take the log; called before the first event."""
        ...

    def end(self) -> None:
        """Write what is left to say; called when all states are left, before the end of the run is recorded."""
        ...


class BusPort:
    """The bus itself."""

    def __init__(self, bus: SkillBus) -> None:
        self._bus = bus

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        """Ask a service; raises what the bus raises."""
        return await self._bus.call(request, to=to, holder=holder)

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        """Send a goal; raises what the bus raises."""
        return self._bus.send_goal(goal, to=to, holder=holder, goal_id=goal_id)

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the newest message of a topic, waiting for the first one."""
        newest = self._bus.topic(topic, kind).latest
        return newest if newest is not None else await self.next_message(topic, kind, holder=holder)

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Wait for the next message of a topic."""
        with self._bus.topic(topic, kind).stream(size=1) as stream:
            return await stream.next()

    def watch(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call back at each new message of a topic that was read; returns what ends it."""
        return self._bus.find_topic(topic).subscribe(lambda _: callback()).close

    @property
    def entries(self) -> EntrySchedule | None:
        """None: what comes is not known."""
        return None

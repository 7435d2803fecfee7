"""The skill port that injects faults into requests; wraps the bus, a recording, or any other port."""

from __future__ import annotations

import os
import signal
from collections.abc import Awaitable, Callable
from functools import partial
from typing import Any, TypeVar

import msgspec

from engine.bus import Holder
from engine.clock import Clock
from engine.document.faults import Faults
from engine.event import Event
from engine.faults.fault_context import FaultContext
from engine.faults.fault_rule import FaultRule
from engine.faults.faulty_goal_sender import RepeatableGoal, send_faulty_goal
from engine.faults.request_faults import RepeatableRequest, apply_request_fault
from engine.runtime.record.recorder import Recorder
from engine.runtime.record.skill_port import EntrySchedule, Goal, RunAwarePort, SkillPort, every_message
from engine.skill import Action, Service

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)
M = TypeVar("M")


def kill_process() -> None:
    """End this process at once, as `kill -9` does."""
    os.kill(os.getpid(), signal.SIGKILL)


class FaultPort:
    """Applies the faults of a document to the requests of one run.

    Args:
        inner: The port that answers the requests.
        faults: The faults, in order of precedence.
        clock: The run's time.
        seed: The run's seed, for faults with a probability.
        kill: Ends the process for `crash`.
    """

    def __init__(
        self,
        inner: SkillPort,
        faults: Faults,
        *,
        clock: Clock,
        seed: int = 0,
        kill: Callable[[], None] = kill_process,
    ) -> None:
        self._inner = inner
        self._scene = FaultContext(clock, kill)
        self._rules = tuple(
            FaultRule(fault, number=index + 1, seed=seed, position=faults.position(index))
            for index, fault in enumerate(faults.document.faults)
        )
        self._again: dict[tuple[str, str], Any] = {}

    def begin(self, recorder: Recorder) -> None:
        """Set the recorder of applied faults; the run calls it before it starts."""
        self._scene.recorder = recorder
        if isinstance(self._inner, RunAwarePort):
            self._inner.begin(recorder)
        if any(rule.fault.crashes_at is not None for rule in self._rules):
            recorder.watch(self._crash_at)

    def end(self) -> None:
        """Log faults that were never applied; the run calls it after all states end, before it records its end."""
        self._scene.over = True
        for line in self.unapplied():
            self._scene.warn(line)
        if isinstance(self._inner, RunAwarePort):
            self._inner.end()

    def unapplied(self) -> tuple[str, ...]:
        """Return a line for every fault that was not applied: name, position and reason."""
        return tuple(
            f"{rule.label} ({rule.fault.kind}, {rule.position}) was never applied: {rule.why_not()}"
            for rule in self._rules
            if not rule.applied
        )

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        """Call a service, unless a fault intervenes; raises the errors of the bus."""
        address = request.address(to)
        rule = self._due(holder.branch, address)
        if rule is None:
            return await self._inner.call(request, to=to, holder=holder)

        async def ask() -> R:
            return await self._inner.call(request, to=to, holder=holder)

        return await apply_request_fault(rule, RepeatableRequest(holder.branch, address, ask), self._scene)

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        """Send a goal, unless a fault intervenes; raises the errors of the bus."""
        sending = RepeatableGoal(self._inner, goal, to, holder, goal_id)
        rule = self._due(holder.branch, sending.address)
        if rule is None:
            return sending()
        return send_faulty_goal(rule, sending, self._scene)

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the latest message of a topic, unless a fault intervenes."""

        async def read() -> S:
            return await self._inner.latest(topic, kind, holder=holder)

        return await self._read(topic, holder, read, partial(self._inner.next_message, topic, kind, holder=holder))

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Wait for the next message of a topic, unless a fault intervenes."""

        async def read() -> S:
            return await self._inner.next_message(topic, kind, holder=holder)

        return await self._read(topic, holder, read, read)

    async def latest_data(self, topic: str, *, holder: Holder) -> object:
        """Return the latest message of a topic, unless a fault intervenes."""

        async def read() -> object:
            return await self._inner.latest_data(topic, holder=holder)

        return await self._read(
            topic, holder, read, partial(self._inner.next_data, topic, every_message, holder=holder)
        )

    async def next_data(self, topic: str, condition: Callable[[object], bool], *, holder: Holder) -> object:
        """Wait for the next message of a topic that meets the condition, unless a fault intervenes."""

        async def read() -> object:
            return await self._inner.next_data(topic, condition, holder=holder)

        return await self._read(topic, holder, read, read, fits=condition)

    def publish(self, topic: str, message: object, *, holder: Holder) -> None:
        """Publish a message; faults are those of requests and reads."""
        self._inner.publish(topic, message, holder=holder)

    def watch(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Call back at each new message of a topic; faults of topics apply when a message is read."""
        return self._inner.watch(topic, callback)

    @property
    def entries(self) -> EntrySchedule | None:
        """Those of what is inside."""
        return self._inner.entries

    async def _read(
        self,
        topic: str,
        holder: Holder,
        read: Callable[[], Awaitable[M]],
        read_next: Callable[[], Awaitable[M]],
        *,
        fits: Callable[[object], bool] = every_message,
    ) -> M:
        again: M | None = self._again.pop((holder.branch, topic), None)
        if again is not None and fits(again):
            return again
        rule = self._due(holder.branch, topic)
        if rule is None:
            return await read()
        if rule.fault.duplicate is not None:
            message = await read()
            self._scene.apply(rule, holder.branch, topic, "the next read gives the same message again")
            self._again[holder.branch, topic] = message
            return message
        if rule.fault.lost is not None:
            await read()
            self._scene.apply(rule, holder.branch, topic, "a message is lost")
            return await read_next()
        return await apply_request_fault(rule, RepeatableRequest(holder.branch, topic, read), self._scene)

    def _due(self, path: str, address: str) -> FaultRule | None:
        """Return the first fault that is due; every matching fault counts the request."""
        wanting = [rule for rule in self._rules if rule.wants(path, address)]
        return wanting[0] if wanting else None

    def _crash_at(self, event: Event) -> None:
        for rule in self._rules:
            if rule.fault.crashes_at == event.seq:
                rule.applied += 1
                self._scene.kill()

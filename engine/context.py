"""What a running state sees of its run: time, skills, topics, log, random numbers."""

from __future__ import annotations

import asyncio
from typing import Any, TypeVar

import msgspec

from engine.bus import GoalEnd, GoalHandle, GoalStatus, Holder
from engine.clock import Clock
from engine.event import Cause, GoalFinished, GoalSent
from engine.execution import Execution
from engine.node import log
from engine.skill import Action, Service
from engine.state import ActionEnd

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)


class WaitingClock:
    """The run's clock, noting that the state waited so that endless instant loops are told apart."""

    def __init__(self, execution: Execution) -> None:
        self._execution = execution

    @property
    def virtual(self) -> bool:
        """True when time passes only as fast as the work that needs it."""
        return self._execution.clock.virtual

    def now_s(self) -> float:
        """Seconds since the run's clock started."""
        return self._execution.clock.now_s()

    async def sleep(self, duration_s: float) -> None:
        """Let `duration_s` pass."""
        if duration_s > 0:
            self._execution.waits += 1
        await self._execution.clock.sleep(duration_s)


class RunningContext:
    """The `engine.state.Context` of one activation of one state."""

    __slots__ = ("_execution", "_goals", "_visit", "path")

    def __init__(self, execution: Execution, path: str, visit: int) -> None:
        self._execution = execution
        self.path = path
        self._visit = visit
        self._goals = 0

    @property
    def clock(self) -> Clock:
        """The run's time."""
        return WaitingClock(self._execution)

    async def call(self, request: Service[R], *, to: str) -> R:
        """Ask a service after the journal is durable, as it may have an effect."""
        await self._execution.recorder.commit()
        answer = await self._execution.bus.call(request, to=to)
        self._execution.waits += 1
        return answer

    async def perform(self, goal: Action[R, F], *, to: str) -> ActionEnd[R]:
        """Send a goal and wait for its end; when preempted, cancel it and wait for rest."""
        execution = self._execution
        execution.waits += 1
        self._goals += 1
        goal_id = f"{self.path}#{self._visit}.{self._goals}"
        self._record_sent(goal_id, goal, f"{to}/{goal.skill_name()}")
        await execution.recorder.commit()
        holder = Holder(execution.run, self.path)
        handle = execution.bus.send_goal(goal, to=to, holder=holder, goal_id=goal_id)
        try:
            end = await handle.result()
        except asyncio.CancelledError:
            self._record_finished(await _cancelled(handle), goal_id)
            raise
        self._record_finished(end, goal_id)
        return ActionEnd(end.status.value, end.result, end.cause)

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Return the newest message of a topic, waiting for the first one."""
        newest = self._execution.bus.topic(topic, kind).latest
        return newest if newest is not None else await self.next_message(topic, kind)

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Wait for the next message of a topic."""
        self._execution.waits += 1
        with self._execution.bus.topic(topic, kind).stream(size=1) as stream:
            return await stream.next()

    def log(self, message: str, *, level: str = "info") -> None:
        """Write a line into the event log."""
        log(self._execution, self.path, message, level=level)

    def random(self) -> float:
        """A number in [0, 1) from the run's seed."""
        return self._execution.random.random()

    def _record_sent(self, goal_id: str, goal: Action[Any, Any], address: str) -> None:
        recorder = self._execution.recorder
        recorder.record(
            GoalSent(
                seq=recorder.next_seq(),
                time_s=recorder.now_s(),
                path=self.path,
                goal=goal_id,
                address=address,
                request=msgspec.to_builtins(goal),
            )
        )

    def _record_finished(self, end: GoalEnd[Any], goal_id: str) -> None:
        recorder = self._execution.recorder
        recorder.record(
            GoalFinished(
                seq=recorder.next_seq(),
                time_s=recorder.now_s(),
                path=self.path,
                goal=goal_id,
                status=end.status.value,
                result=msgspec.to_builtins(end.result) if end.result is not None else None,
                cause=end.cause,
            )
        )


async def _cancelled(handle: GoalHandle[Any, Any]) -> GoalEnd[Any]:
    """Cancel a goal and wait until its server confirms, however often we are cancelled meanwhile."""
    handle.cancel()
    while True:
        try:
            return await handle.result()
        except asyncio.CancelledError:
            if handle.finished:
                return GoalEnd(GoalStatus.CANCELED, None, Cause(message="the action server went away"))

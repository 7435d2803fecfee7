"""Context of a running state: time, skills, topics, log, random numbers."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping
from typing import Any, TypeVar

import msgspec

from engine.bus import Holder
from engine.cause_chain import cause_of
from engine.clock import Clock, OneTurn
from engine.errors import Cause, FlexcellError
from engine.event import (
    GoalFinished,
    GoalHeld,
    GoalResumed,
    GoalSent,
    MessagePublished,
    MessageReceived,
    ServiceAnswered,
    ServiceCalled,
)
from engine.runtime.nodes.execution import Execution
from engine.runtime.record.nonfinite import encode_nonfinite
from engine.runtime.record.recorder import Recorder
from engine.runtime.record.skill_port import Goal
from engine.skill import Action, Service
from engine.skills.goal_end import GoalEnd, GoalStatus

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)
M = TypeVar("M")


class HoldableClock:
    """The clock of a run for one state: its sleeps are paused while the branch of the state is held."""

    def __init__(self, execution: Execution, path: str) -> None:
        self._execution = execution
        self._path = path

    @property
    def virtual(self) -> bool:
        """True when time advances only with the work that consumes it."""
        return self._execution.clock.virtual

    def now_s(self) -> float:
        """Seconds since the start of the clock."""
        self._execution.progress_count += 1
        return self._execution.clock.now_s()

    def sleep(self, duration_s: float) -> Coroutine[Any, Any, None]:
        """Wait for `duration_s`."""
        if duration_s == 0:
            return OneTurn()
        # Returned, not awaited: every wake-up traverses each coroutine around a wait.
        return self._execution.sleep(self._path, duration_s)


class HoldableGoal:
    """A goal that the run holds and resumes with its branch."""

    def __init__(self, goal: Goal, goal_id: str, path: str, recorder: Recorder) -> None:
        self._goal = goal
        self._recorder = recorder
        self.label = goal_id
        self.path = path

    async def hold(self) -> None:
        """Bring the device to rest; raises BusError where the skill cannot be held."""
        await self._goal.hold()
        if not self._goal.finished:
            self._recorder.emit(GoalHeld, path=self.path, goal=self.label)

    async def resume(self) -> None:
        """Resume the goal."""
        await self._goal.resume()
        if not self._goal.finished:
            self._recorder.emit(GoalResumed, path=self.path, goal=self.label)


class ActivationContext(msgspec.Struct, eq=False):
    """The `engine.state.Context` of one activation of one state.

    One is created for every entered state; a struct is three times faster to create than a class.
    """

    _execution: Execution
    path: str
    _visit: int
    _autonomy: Mapping[str, str]
    _goals: int = 0
    _calls: int = 0
    _clock: HoldableClock | None = None

    @property
    def clock(self) -> Clock:
        """The clock of the run."""
        clock = self._clock
        if clock is None:
            clock = self._clock = HoldableClock(self._execution, self.path)
        return clock

    async def call(self, request: Service[R], *, to: str) -> R:
        """Call a service once the journal is durable, as the call may have an effect."""
        execution = self._execution
        await execution.branch_holds.until_free(self.path)
        self._calls += 1
        call = f"{self.path}#{self._visit}.c{self._calls}"
        with execution.pending_calls.of(self.path):
            self._record_called(call, request, request.address(to))
            await execution.commit()
            try:
                answer = await self._answer(request, to)
            except FlexcellError as error:
                self._record_answered(call, None, cause_of(error))
                raise
            self._record_answered(call, answer, None)
        self._count_progress()
        return answer

    async def perform(self, goal: Action[R, F], *, to: str) -> GoalEnd[R]:
        """Send a goal and wait for its end; on preemption, cancel it and wait until the device is at rest."""
        execution = self._execution
        self._count_progress()
        await execution.branch_holds.until_free(self.path)
        self._goals += 1
        goal_id = f"{self.path}#{self._visit}.{self._goals}"
        self._record_sent(goal_id, goal, goal.address(to))
        try:
            await execution.commit()
            sent = execution.skills.send_goal(goal, to=to, holder=self._holder, goal_id=goal_id)
        except FlexcellError as error:
            self._record_finished(GoalEnd(GoalStatus.REJECTED, None, cause_of(error)), goal_id)
            raise
        except asyncio.CancelledError:
            self._record_finished(GoalEnd(GoalStatus.CANCELED, None, None), goal_id)
            raise
        held = HoldableGoal(sent, goal_id, self.path, execution.recorder)
        execution.branch_holds.attach(held)
        try:
            end = await sent.result()
        except asyncio.CancelledError:
            self._record_finished(await _cancelled(sent), goal_id)
            raise
        finally:
            await execution.branch_holds.detach(held)
        self._record_finished(end, goal_id)
        return end

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Return the latest message of a topic, waiting for the first one."""
        self._count_progress()
        return self._received(topic, await self._execution.skills.latest(topic, kind, holder=self._holder))

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Wait for the next message of a topic."""
        self._count_progress()
        return self._received(topic, await self._execution.skills.next_message(topic, kind, holder=self._holder))

    async def latest_data(self, topic: str) -> object:
        """Return the latest message of a topic as plain data, waiting for the first one."""
        self._count_progress()
        return self._received(topic, await self._execution.skills.latest_data(topic, holder=self._holder))

    async def next_data(self, topic: str, condition: Callable[[object], bool]) -> object:
        """Wait for the next message of a topic that meets the condition; it alone is recorded."""
        self._count_progress()
        return self._received(topic, await self._execution.skills.next_data(topic, condition, holder=self._holder))

    async def publish(self, topic: str, message: object) -> None:
        """Publish a message once the journal is durable, as somebody may act on it."""
        execution = self._execution
        await execution.branch_holds.until_free(self.path)
        execution.progress_count += 1
        execution.recorder.emit(MessagePublished, path=self.path, topic=topic, message=encode_nonfinite(message))
        await execution.commit()
        execution.skills.publish(topic, message, holder=self._holder)

    async def offer(self, outcome: str) -> None:
        """Ask the operator to confirm an outcome where the autonomy level requires it; cancelling withdraws."""
        self._count_progress()
        required = self._autonomy.get(outcome, "off")
        await self._execution.gate.offer(self.path, self._visit, outcome, required)

    def log(self, message: str, *, level: str = "info") -> None:
        """Write a message into the event log."""
        self._execution.recorder.log(self.path, message, level=level)

    def random(self) -> float:
        """Return a number in [0, 1) from the random generator of the run."""
        self._execution.progress_count += 1
        return self._execution.random.random()

    async def _answer(self, request: Service[R], to: str) -> R:
        execution = self._execution
        observed = execution.observed.take(self.path, request, to)
        if observed is None:
            return await execution.skills.call(request, to=to, holder=self._holder)
        if observed.error is not None:
            raise observed.error
        return observed.answer

    def _count_progress(self) -> None:
        """Count a wait for an external answer, which may change each time."""
        self._execution.waits.add(self.path)
        self._execution.progress_count += 1

    @property
    def _holder(self) -> Holder:
        return Holder(self._execution.run, self.path)

    def _received(self, topic: str, message: M) -> M:
        self._execution.recorder.emit(
            MessageReceived, path=self.path, topic=topic, message=encode_nonfinite(msgspec.to_builtins(message))
        )
        return message

    def _record_called(self, call: str, request: Service[Any], address: str) -> None:
        self._execution.recorder.emit(
            ServiceCalled,
            path=self.path,
            call=call,
            address=address,
            request=encode_nonfinite(request.data()),
        )

    def _record_answered(self, call: str, answer: object, cause: Cause | None) -> None:
        self._execution.recorder.emit(
            ServiceAnswered,
            path=self.path,
            call=call,
            result=encode_nonfinite(msgspec.to_builtins(answer)),
            cause=cause,
        )

    def _record_sent(self, goal_id: str, goal: Action[Any, Any], address: str) -> None:
        self._execution.recorder.emit(
            GoalSent,
            path=self.path,
            goal=goal_id,
            address=address,
            request=encode_nonfinite(goal.data()),
        )

    def _record_finished(self, end: GoalEnd[Any], goal_id: str) -> None:
        self._execution.recorder.emit(
            GoalFinished,
            path=self.path,
            goal=goal_id,
            status=end.status.value,
            result=encode_nonfinite(msgspec.to_builtins(end.result)) if end.result is not None else None,
            cause=end.cause,
        )


async def _cancelled(handle: Goal) -> GoalEnd[Any]:
    """Cancel a goal and wait until its server confirms, also when this task is cancelled meanwhile."""
    handle.cancel()
    while True:
        try:
            return await handle.result()
        except asyncio.CancelledError:
            if handle.finished:
                return GoalEnd(GoalStatus.CANCELED, None, Cause(message="the action server is no longer available"))

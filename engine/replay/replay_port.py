"""Replaces the bus: every request of a state receives its recorded response."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, TypeVar

import msgspec

from engine.bus import GoalEnd, GoalStatus, Holder
from engine.errors import BusError, FlexcellError
from engine.event import GoalFinished, ServiceAnswered
from engine.replay.entry_schedule import RecordedEntrySchedule
from engine.replay.recorded_errors import error_from_cause
from engine.replay.recorded_requests import RecordedRequest, RecordedRequests
from engine.replay.recorded_schedule import RecordedSchedule
from engine.replay.replayed_goal import ReplayedGoal, wake_waiter
from engine.runtime.record.nonfinite import decode_nonfinite
from engine.runtime.record.skill_port import EntrySchedule, Goal
from engine.skill import Action, Service

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)


class ReplayPort:
    """Answers a state with its n-th recorded response.

    What the recording does not know waits until the replay is given up; that the request is
    another one than recorded is for the comparison of events to find, which sees it first.
    """

    def __init__(self, requests: RecordedRequests, entries: RecordedEntrySchedule, timetable: RecordedSchedule) -> None:
        self._requests = requests
        self._entries = entries
        self._timetable = timetable
        self._over = False
        self.waiting: dict[str, str] = {}
        """Requests that are missing in the recording, by waiting path."""

    def abort(self) -> None:
        """Stop answering; the run is being stopped."""
        self._over = True

    async def call(self, request: Service[R], *, to: str, holder: Holder) -> R:
        """Return the recorded response at its recorded time; raises the recorded error of the bus."""
        self._require_going_on()
        address = request.address(to)
        recorded = self._requests.take(holder.branch)
        if recorded is None or recorded.ended is None or not isinstance(recorded.end, ServiceAnswered):
            await self._for_ever(holder.branch, f"the answer of {address}")
            raise self._ended()
        await self._until(recorded, recorded.ended.place)
        if recorded.end.cause is not None:
            raise error_from_cause(recorded.end.cause)
        return _typed(recorded.end.result, request.result_type(), address)

    def send_goal(self, goal: Action[R, F], *, to: str, holder: Holder, goal_id: str) -> Goal:
        """Start the recorded goal; raises the recorded error of the bus."""
        self._require_going_on()
        address = goal.address(to)
        recorded = self._requests.take(holder.branch)
        if recorded is None or recorded.ended is None or not isinstance(recorded.end, GoalFinished):
            self.waiting[holder.branch] = f"the end of goal {address}"
            return ReplayedGoal(recorded, _NO_END, self._timetable, lambda: self._over)
        cause = recorded.end.cause
        if cause is not None and recorded.end.status == _REJECTED and cause.kind != "GoalRejected":
            # Sending it failed; what its server refuses afterwards comes as an end.
            raise error_from_cause(cause)
        end = _goal_end(recorded.end, goal.result_type(), address)
        return ReplayedGoal(recorded, end, self._timetable, lambda: self._over)

    async def latest(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the message that was read here in the recording."""
        return await self.next_message(topic, kind, holder=holder)

    async def next_message(self, topic: str, kind: type[S], *, holder: Holder) -> S:
        """Return the message that was read here in the recording, at its recorded time."""
        return _typed(await self._read(topic, holder), kind, topic)

    async def latest_data(self, topic: str, *, holder: Holder) -> object:
        """Return the message that was read here in the recording."""
        return decode_nonfinite(await self._read(topic, holder))

    async def next_data(self, topic: str, condition: Callable[[object], bool], *, holder: Holder) -> object:
        """Return the message that met the condition in the recording, at its recorded time."""
        return decode_nonfinite(await self._read(topic, holder))

    def publish(self, topic: str, message: object, *, holder: Holder) -> None:
        """Do nothing: what the run publishes is compared as an event."""
        self._require_going_on()

    async def _read(self, topic: str, holder: Holder) -> object:
        self._require_going_on()
        recorded = self._requests.take_read(holder.branch, topic)
        if recorded is None:
            await self._for_ever(holder.branch, f"a message of {topic}")
            raise self._ended()
        try:
            await self._wait(recorded.moment.place, max(recorded.moment.at_s, self._timetable.now_s()))
        except asyncio.CancelledError:
            self._requests.give_back(recorded)
            raise
        return recorded.event.message

    def watch(self, topic: str, callback: Callable[[], None]) -> Callable[[], None]:
        """Never call back: what was read is recorded, and what was not is not known."""
        return lambda: None

    @property
    def entries(self) -> EntrySchedule | None:
        """Entry times of nodes in the recording."""
        return self._entries

    async def _until(self, recorded: RecordedRequest, place: int) -> None:
        ended_s = recorded.ended.at_s if recorded.ended is not None else recorded.sent_s
        await self._wait(place, self._timetable.time_for(recorded.sent_s, ended_s))

    async def _wait(self, place: int, at_s: float) -> None:
        arrived: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        due = self._timetable.expect(place, at_s, lambda: wake_waiter(arrived))
        if arrived.done():
            if self._timetable.is_delayed(place):
                await asyncio.sleep(0)
            return
        try:
            await arrived
        finally:
            self._timetable.forget(due)

    async def _for_ever(self, path: str, what: str) -> None:
        self.waiting[path] = what
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            del self.waiting[path]

    def _require_going_on(self) -> None:
        if self._over:
            raise self._ended()

    def _ended(self) -> FlexcellError:
        return BusError("the replay is over", hint="it is being stopped at its first difference")


_NO_END: GoalEnd[Any] = GoalEnd(GoalStatus.CANCELED, None, None)
_REJECTED = GoalStatus.REJECTED.value


def _goal_end(end: GoalFinished, kind: Any, address: str) -> GoalEnd[Any]:
    result = _typed(end.result, kind, address) if end.result is not None else None
    return GoalEnd(GoalStatus(end.status), result, end.cause)


def _typed(value: object, kind: Any, where: str) -> Any:
    try:
        return msgspec.convert(decode_nonfinite(value), kind, str_keys=True)
    except msgspec.ValidationError as error:
        raise BusError(f"the recorded answer does not fit this version: {error}", where=where) from error

"""A goal of a replay: it ends, is held and resumed as in the recording."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from engine.bus import GoalEnd, GoalStatus
from engine.errors import BusError
from engine.replay.recorded_requests import RecordedInstant, RecordedRequest
from engine.replay.recorded_schedule import RecordedSchedule, ScheduledDelivery


class ReplayedGoal:
    """The active recorded goal.

    Args:
        recorded: What the recording has of it; None when it does not know it.
        end: How it ended there.
        timetable: When things happen.
        over: Whether the replay has been given up; then a cancelled goal ends at once.
    """

    def __init__(
        self, recorded: RecordedRequest | None, end: GoalEnd[Any], timetable: RecordedSchedule, over: Callable[[], bool]
    ) -> None:
        self._recorded = recorded
        self._end: GoalEnd[Any] = end
        self._timetable = timetable
        self._over = over
        self._loop = asyncio.get_running_loop()
        self._results: list[asyncio.Future[None]] = []
        self._confirmations: list[asyncio.Future[None]] = []
        self._finished = False
        self._holds = 0
        self._resumes = 0
        self._due: ScheduledDelivery | None = None
        if recorded is not None and recorded.ended is not None:
            at_s = timetable.time_for(recorded.sent_s, recorded.ended.at_s)
            self._due = timetable.expect(recorded.ended.place, at_s, self._finish, late=recorded.cancelled)

    @property
    def finished(self) -> bool:
        """True once it has ended."""
        return self._finished

    async def result(self) -> GoalEnd[Any]:
        """Wait for the end; cancelling this wait does not cancel the goal."""
        await self._ended(self._results)
        return self._end

    def cancel(self) -> None:
        """End as recorded; immediately if the recording has no end, or the replay is over."""
        if self._finished:
            return
        if self._due is None or self._over():
            self._end = GoalEnd(GoalStatus.CANCELED, None, None)
            self._loop.call_soon(self._finish)
        else:
            self._timetable.request_delivery(self._due)

    async def hold(self) -> None:
        """Return when the goal was held in the recording, or when it has ended before that.

        Raises:
            BusError: it could not be held.
        """
        if self._recorded is not None and self._recorded.cannot_hold:
            raise BusError(self._recorded.cannot_hold)
        self._holds += 1
        await self._confirmed(self._recorded.held if self._recorded is not None else [], self._holds)

    async def resume(self) -> None:
        """Return when the goal was resumed in the recording, or when it has ended before that."""
        self._resumes += 1
        await self._confirmed(self._recorded.resumed if self._recorded is not None else [], self._resumes)

    async def _confirmed(self, instants: list[RecordedInstant], number: int) -> None:
        if number > len(instants):
            await self._ended(self._confirmations)
            return
        moment = instants[number - 1]
        waiter = self._waiter(self._confirmations)
        due = self._timetable.expect(moment.place, moment.at_s, lambda: wake_waiter(waiter))
        try:
            await waiter
        finally:
            self._timetable.forget(due)

    async def _ended(self, waiters: list[asyncio.Future[None]]) -> None:
        if not self._finished:
            # A future for each who waits: one turn of the loop from the end to the state, as short as a timer's.
            await self._waiter(waiters)
        elif self._due is not None and self._timetable.is_delayed(self._due.place):
            await asyncio.sleep(0)

    def _waiter(self, waiters: list[asyncio.Future[None]]) -> asyncio.Future[None]:
        waiter: asyncio.Future[None] = self._loop.create_future()
        waiters.append(waiter)
        return waiter

    def _finish(self) -> None:
        self._finished = True
        if self._due is not None:
            self._timetable.forget(self._due)
        # Who holds it has nothing left to do when its state goes on; else the state would wait for that.
        for waiter in (*self._confirmations, *self._results):
            wake_waiter(waiter)


def wake_waiter(waiter: asyncio.Future[None]) -> None:
    """Wake the waiting task, unless it was cancelled."""
    if not waiter.done():
        waiter.set_result(None)

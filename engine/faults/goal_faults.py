"""How a faulty goal ends: one coroutine for each kind of fault."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.bus import GoalEnd, GoalStatus
from engine.clock import Clock
from engine.event import Cause
from engine.faults.faulty_goal import AnyGoalEnd, FaultyGoal, GoalScript
from engine.runtime.record.skill_port import Goal

_CANCELED: AnyGoalEnd = GoalEnd(GoalStatus.CANCELED, None, None)


def pass_through(sent: Goal) -> GoalScript:
    """It ends as it does."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        return await sent.result()

    return play


def delay_end(sent: Goal, delay_s: float, clock: Clock) -> GoalScript:
    """The end is told late, that of a cancel too."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        await clock.sleep(delay_s)
        return end

    return play


def withhold_end(sent: Goal) -> GoalScript:
    """The end is never told; a cancel is passed on and confirmed."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        await goal.cancel_asked.wait()
        end = await sent.result()
        return GoalEnd(GoalStatus.CANCELED, end.result, end.cause)

    return play


def ignore_all() -> GoalScript:
    """It has no end, whatever is asked."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        endless: asyncio.Future[AnyGoalEnd] = asyncio.get_running_loop().create_future()
        return await endless

    return play


def fail_goal(status: GoalStatus, cause: Cause, after_s: float, clock: Clock) -> GoalScript:
    """It ends so, at once or after a time; the device never got it."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        if after_s:
            await clock.sleep(after_s)
        return GoalEnd(status, None, cause)

    return play


def abort_after(sent: Goal, after_s: float, cause: Cause) -> GoalScript:
    """It is under way for a time, then the device stops and says that it failed."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        try:
            async with asyncio.timeout(after_s):
                await sent.result()
        except TimeoutError:
            sent.cancel()
        end = await sent.result()
        return end if goal.cancel_asked.is_set() else GoalEnd(GoalStatus.ABORTED, end.result, cause)

    return play


def lose_request() -> GoalScript:
    """The device never gets it; a cancel finds nothing to cancel."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        await goal.cancel_asked.wait()
        return _CANCELED

    return play


def lose_answer(sent: Goal) -> GoalScript:
    """The device does it and the answer is lost; who asks for a cancel is told how it ended."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        await goal.cancel_asked.wait()
        return end

    return play


def copy_at_once(sent: Goal, copy: Goal) -> GoalScript:
    """Two of the same goal are under way; the end of the first counts once both are over."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        await copy.result()
        return end

    return play


def copy_after_end(sent: Goal, send_again: Callable[[], Goal | None]) -> GoalScript:
    """The same goal arrives again when it has ended; its first end counts once both are over."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        copy = None if goal.cancel_asked.is_set() else send_again()
        if copy is not None:
            goal.deliver(copy)
            await copy.result()
        return end

    return play


def kill_after(sent: Goal, kill: Callable[[], None]) -> GoalScript:
    """The process dies when the device is done, before the end is told."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        kill()
        return end

    return play

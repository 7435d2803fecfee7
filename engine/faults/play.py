"""How a goal ends that a fault is applied to: one short coroutine for each kind of fault."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from engine.bus import GoalEnd, GoalStatus
from engine.clock import Clock
from engine.event import Cause
from engine.faults.goal import End, FaultyGoal, Play
from engine.skill_port import Goal

_CANCELED: End = GoalEnd(GoalStatus.CANCELED, None, None)


def tell(sent: Goal) -> Play:
    """It ends as it does."""

    async def play(goal: FaultyGoal) -> End:
        return await sent.result()

    return play


def late(sent: Goal, delay_s: float, clock: Clock) -> Play:
    """The end is told late, that of a cancel too."""

    async def play(goal: FaultyGoal) -> End:
        end = await sent.result()
        await clock.sleep(delay_s)
        return end

    return play


def hang(sent: Goal) -> Play:
    """The end is never told; a cancel is passed on and confirmed."""

    async def play(goal: FaultyGoal) -> End:
        await goal.cancel_asked.wait()
        end = await sent.result()
        return GoalEnd(GoalStatus.CANCELED, end.result, end.cause)

    return play


def never() -> Play:
    """It has no end, whatever is asked."""

    async def play(goal: FaultyGoal) -> End:
        endless: asyncio.Future[End] = asyncio.get_running_loop().create_future()
        return await endless

    return play


def fail(status: GoalStatus, cause: Cause, after_s: float, clock: Clock) -> Play:
    """It ends so, at once or after a time; the device never got it."""

    async def play(goal: FaultyGoal) -> End:
        if after_s:
            await clock.sleep(after_s)
        return GoalEnd(status, None, cause)

    return play


def break_off(sent: Goal, after_s: float, cause: Cause) -> Play:
    """It is under way for a time, then the device stops and says that it failed."""

    async def play(goal: FaultyGoal) -> End:
        try:
            async with asyncio.timeout(after_s):
                await sent.result()
        except TimeoutError:
            sent.cancel()
        end = await sent.result()
        return end if goal.cancel_asked.is_set() else GoalEnd(GoalStatus.ABORTED, end.result, cause)

    return play


def lose_request() -> Play:
    """The device never gets it; a cancel finds nothing to cancel."""

    async def play(goal: FaultyGoal) -> End:
        await goal.cancel_asked.wait()
        return _CANCELED

    return play


def lose_answer(sent: Goal) -> Play:
    """The device does it and the answer is lost; who asks for a cancel is told how it ended."""

    async def play(goal: FaultyGoal) -> End:
        end = await sent.result()
        await goal.cancel_asked.wait()
        return end

    return play


def copy_at_once(sent: Goal, copy: Goal) -> Play:
    """Two of the same goal are under way; the end of the first counts once both are over."""

    async def play(goal: FaultyGoal) -> End:
        end = await sent.result()
        await copy.result()
        return end

    return play


def copy_after_end(sent: Goal, send_again: Callable[[], Goal | None]) -> Play:
    """The same goal arrives again when it has ended; its first end counts once both are over."""

    async def play(goal: FaultyGoal) -> End:
        end = await sent.result()
        copy = None if goal.cancel_asked.is_set() else send_again()
        if copy is not None:
            goal.deliver(copy)
            await copy.result()
        return end

    return play


def kill_after(sent: Goal, kill: Callable[[], None]) -> Play:
    """The process dies when the device is done, before the end is told."""

    async def play(goal: FaultyGoal) -> End:
        end = await sent.result()
        kill()
        return end

    return play

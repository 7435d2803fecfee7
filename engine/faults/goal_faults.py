"""End of a faulty goal: one coroutine for each kind of fault."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

from engine.bus import GoalEnd, GoalStatus
from engine.cause_chain import cause_of
from engine.clock import Clock
from engine.errors import Cause, FlexcellError
from engine.faults.faulty_goal import AnyGoalEnd, FaultyGoal, GoalScript
from engine.runtime.record.skill_port import Goal

_CANCELED: AnyGoalEnd = GoalEnd(GoalStatus.CANCELED, None, None)


def pass_through(sent: Goal) -> GoalScript:
    """Let the goal end normally."""

    async def play(_goal: FaultyGoal) -> AnyGoalEnd:
        return await sent.result()

    return play


def delay_end(sent: Goal, delay_s: float, clock: Clock) -> GoalScript:
    """Report the end late, also after a cancel."""

    async def play(_goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        await clock.sleep(delay_s)
        return end

    return play


def withhold_end(sent: Goal) -> GoalScript:
    """Report no end; a cancel is forwarded and confirmed."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        await goal.cancel_asked.wait()
        end = await sent.result()
        return GoalEnd(GoalStatus.CANCELED, end.result, end.cause)

    return play


def ignore_all() -> GoalScript:
    """Let the goal never end, even after a cancel."""

    async def play(_goal: FaultyGoal) -> AnyGoalEnd:
        endless: asyncio.Future[AnyGoalEnd] = asyncio.get_running_loop().create_future()
        return await endless

    return play


def fail_goal(status: GoalStatus, cause: Cause, after_s: float, clock: Clock) -> GoalScript:
    """End the goal with this failure, immediately or after a time; the device never received it."""

    async def play(_goal: FaultyGoal) -> AnyGoalEnd:
        if after_s:
            await clock.sleep(after_s)
        return GoalEnd(status, None, cause)

    return play


def abort_after(sent: Goal, after_s: float, cause: Cause) -> GoalScript:
    """Let the goal be active for a time; then the device stops and reports a failure."""

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
    """Keep the goal from the device; a cancel has no effect."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        await goal.cancel_asked.wait()
        return _CANCELED

    return play


def lose_answer(sent: Goal) -> GoalScript:
    """Lose the result of the goal that the device executes; a cancel returns the result."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        await goal.cancel_asked.wait()
        return end

    return play


def copy_at_once(sent: Goal, copy: Goal) -> GoalScript:
    """Two copies of the goal are active; the end of the first is reported after both have ended."""

    async def play(_goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        await copy.result()
        return end

    return play


def copy_after_end(sent: Goal, send_again: Callable[[], Goal | None]) -> GoalScript:
    """Send the goal again after its end; the first end is reported after both have ended."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        copy = None if goal.cancel_asked.is_set() else send_again()
        if copy is not None:
            goal.deliver(copy)
            await copy.result()
        return end

    return play


def send_after(prepare: Callable[[], Awaitable[None]], send: Callable[[], Goal]) -> GoalScript:
    """Prepare something, then send the goal and let it end normally; what fails in it ends the goal."""

    async def play(goal: FaultyGoal) -> AnyGoalEnd:
        try:
            await prepare()
            sent = send()
        except FlexcellError as error:
            return GoalEnd(GoalStatus.ABORTED, None, cause_of(error))
        goal.deliver(sent)
        if goal.cancel_asked.is_set():
            sent.cancel()
        return await sent.result()

    return play


def kill_after(sent: Goal, kill: Callable[[], None]) -> GoalScript:
    """Kill the process when the device has finished, before the end is reported."""

    async def play(_goal: FaultyGoal) -> AnyGoalEnd:
        end = await sent.result()
        kill()
        return end

    return play

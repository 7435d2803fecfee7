"""The course of one goal: orders that come too early, too late or twice change nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import pytest

from engine.bus import ActiveGoal, GoalHandle, GoalStatus, Holder, SkillBus
from engine.clock import new_clock
from engine.errors import BusError, GoalRejected, SkillFailed
from engine.skills.gripper import GraspResult, GripperFeedback, GripperOpen

HELD = GraspResult(held=True, width_m=0.03, force_n=20.0)
Goal = ActiveGoal[GripperFeedback]
Handle = GoalHandle[GraspResult, GripperFeedback]


def sent(handler: Callable[[Goal], Awaitable[GraspResult]]) -> Handle:
    """Return a goal that was just sent to this handler."""
    bus = SkillBus(new_clock())

    async def serve(goal: GripperOpen, handle: Goal) -> GraspResult:
        return await handler(handle)

    bus.advertise_action(GripperOpen, serve, namespace="left/gripper")
    return bus.send_goal(GripperOpen(), to="left/gripper", holder=Holder("run-1"))


async def test_a_cancel_after_the_end_changes_nothing() -> None:
    async def done(goal: Goal) -> GraspResult:
        goal.accept()
        return HELD

    handle = sent(done)
    assert not handle.finished
    await handle.result()
    handle.cancel()
    await handle.hold()
    await handle.resume()
    assert (handle.finished, handle.status) == (True, GoalStatus.SUCCEEDED)


async def test_a_cancel_reaches_a_server_that_asks_for_it_late() -> None:
    """It was cancelled while it prepared the stop; a second cancel does not stop it once more."""
    log, going = list[str](), asyncio.Event()

    async def prepare(goal: Goal) -> GraspResult:
        goal.on_cancel(lambda: log.append("first"))
        goal.accept()
        await going.wait()
        goal.on_cancel(lambda: log.append("second"))
        return HELD

    handle = sent(prepare)
    await handle.accepted()
    handle.cancel()
    handle.cancel()
    assert (handle.status, log) == (GoalStatus.CANCELING, ["first"])
    going.set()
    end = await handle.result()
    assert (end.status, end.result, log) == (GoalStatus.CANCELED, HELD, ["first", "second"])


async def test_a_server_that_accepts_after_a_cancel_is_notified_and_the_goal_has_not_begun() -> None:
    """A rejection afterwards is not one: the goal ends as cancelled."""
    going = asyncio.Event()

    async def plan(goal: Goal) -> GraspResult:
        goal.on_cancel(lambda: None)
        await going.wait()
        goal.accept()
        raise AssertionError("it was accepted")

    handle = sent(plan)
    await asyncio.sleep(0)
    handle.cancel()
    assert handle.status is GoalStatus.PENDING
    going.set()
    await handle.accepted()
    end = await handle.result()
    assert (end.status, end.result, end.cause) == (GoalStatus.CANCELED, None, None)


async def test_who_has_accepted_aborts_and_does_not_reject() -> None:
    async def reject_late(goal: Goal) -> GraspResult:
        goal.accept()
        raise GoalRejected("too wide", where="left/gripper")

    handle = sent(reject_late)
    await handle.accepted()
    end = await handle.result()
    assert (end.status, end.cause and end.cause.message) == (GoalStatus.ABORTED, "too wide")


async def test_a_failure_keeps_what_was_reached() -> None:
    async def fail(goal: Goal) -> GraspResult:
        goal.accept()
        error = SkillFailed("the fingers are blocked", where="left/gripper")
        error.result = HELD
        raise error

    end = await sent(fail).result()
    assert (end.status, end.result) == (GoalStatus.ABORTED, HELD)


async def test_an_error_with_words_of_its_own_aborts_without_a_result() -> None:
    async def fail(goal: Goal) -> GraspResult:
        goal.accept()
        raise BusError("the wire is cut", where="left/gripper")

    end = await sent(fail).result()
    assert (end.status, end.result, end.cause and end.cause.message) == (GoalStatus.ABORTED, None, "the wire is cut")


async def test_a_server_that_ends_during_the_hold_has_ended() -> None:
    """A hold that comes with the end does not make a held goal of one that is over."""
    finish = asyncio.Event()

    async def work(goal: Goal) -> GraspResult:
        goal.accept()

        async def hold() -> None:
            finish.set()
            await asyncio.sleep(0)
            await asyncio.sleep(0)

        goal.on_hold(hold)
        await finish.wait()
        return HELD

    handle = sent(work)
    await handle.accepted()
    await handle.hold()
    assert ((await handle.result()).status, handle.status) == (GoalStatus.SUCCEEDED, GoalStatus.SUCCEEDED)


async def test_a_cancel_during_the_hold_is_not_forgotten() -> None:
    """The goal is being cancelled, not held; to resume it would start what is to stop."""
    log, stopped = list[str](), asyncio.Event()

    async def work(goal: Goal) -> GraspResult:
        goal.accept()

        async def hold() -> None:
            handle.cancel()

        async def resume() -> None:
            log.append("resumed")

        goal.on_hold(hold)
        goal.on_resume(resume)
        goal.on_cancel(lambda: log.append("stopping"))
        await stopped.wait()
        return HELD

    handle = sent(work)
    await handle.accepted()
    await handle.hold()
    assert handle.status is GoalStatus.CANCELING
    await handle.hold()
    await handle.resume()
    assert (handle.status, log) == (GoalStatus.CANCELING, ["stopping"])
    stopped.set()
    assert (await handle.result()).status is GoalStatus.CANCELED


async def test_a_goal_is_held_once_and_resumed_once() -> None:
    """Also by a server that only holds."""
    log, finish = list[str](), asyncio.Event()

    async def work(goal: Goal) -> GraspResult:
        goal.accept()

        async def hold() -> None:
            log.append("held")

        goal.on_hold(hold)
        await finish.wait()
        return HELD

    handle = sent(work)
    await handle.accepted()
    await handle.resume()
    await handle.hold()
    await handle.hold()
    assert (handle.status, log) == (GoalStatus.HELD, ["held"])
    await handle.resume()
    assert handle.status is GoalStatus.ACTIVE
    await handle.hold()
    assert (handle.status, log) == (GoalStatus.HELD, ["held", "held"])
    finish.set()
    assert (await handle.result()).status is GoalStatus.SUCCEEDED


async def test_a_goal_that_is_rejected_is_not_held() -> None:
    async def reject(goal: Goal) -> GraspResult:
        raise GoalRejected("too wide", where="left/gripper")

    handle = sent(reject)
    await handle.hold()
    assert handle.status is GoalStatus.REJECTED


async def test_whoever_listens_hears_all_feedback_from_then_on() -> None:
    going, heard, late = asyncio.Event(), list[float](), list[float]()

    async def work(goal: Goal) -> GraspResult:
        goal.accept()
        goal.feedback(GripperFeedback(width_m=0.05))
        await going.wait()
        goal.feedback(GripperFeedback(width_m=0.04))
        return HELD

    handle = sent(work)
    handle.on_feedback(lambda each: heard.append(each.width_m))
    await handle.accepted()
    assert handle.feedback == GripperFeedback(width_m=0.05)
    handle.on_feedback(lambda each: late.append(each.width_m))
    going.set()
    await handle.result()
    assert (heard, late, handle.feedback) == ([0.05, 0.04], [0.04], GripperFeedback(width_m=0.04))


async def test_who_stops_waiting_for_a_result_does_not_stop_the_goal() -> None:
    finish = asyncio.Event()

    async def work(goal: Goal) -> GraspResult:
        goal.accept()
        await finish.wait()
        return HELD

    handle = sent(work)
    with pytest.raises(TimeoutError):
        await asyncio.wait_for(handle.result(), timeout=0.001)
    assert handle.status is GoalStatus.ACTIVE
    finish.set()
    assert (await handle.result()).result == HELD

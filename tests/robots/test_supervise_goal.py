"""A goal is over when its motion is, and its device at rest, whatever happens to the goal meanwhile."""

from __future__ import annotations

import asyncio

import pytest

from engine.bus import ActiveGoal, Holder
from engine.errors import RobotError, SkillFailed
from robots.supervise_goal import FEEDBACK_S, supervise_goal
from tests.robots.fake_port import STOPPING_S, FakeMotion

DURATION_S = 1.0


class DeafMotion(FakeMotion):
    """Takes no more commands."""

    def cancel(self) -> None:
        raise RobotError("the line is dead")


def new_goal() -> ActiveGoal[str]:
    """A goal that has been accepted."""
    goal: ActiveGoal[str] = ActiveGoal("g1", "left/move", Holder("run"))
    goal.accept()
    return goal


async def attended(motion: FakeMotion, goal: ActiveGoal[str]) -> None:
    """Attend with the words of an arm."""
    await supervise_goal(
        motion, goal, publish=lambda: goal.feedback(f"{motion.progress:.2f}"), device="left", words="the arm"
    )


@pytest.mark.virtual
async def test_feedback_comes_on_the_way_and_at_the_end() -> None:
    goal = new_goal()
    heard: list[str] = []
    goal.feedback_listeners.append(heard.append)
    await attended(FakeMotion(DURATION_S), goal)
    assert len(heard) == pytest.approx(DURATION_S / FEEDBACK_S, abs=1)
    assert heard[-1] == "1.00"


@pytest.mark.virtual
async def test_a_goal_that_is_cancelled_twice_still_waits_until_the_device_rests() -> None:
    """The second cancel comes while the device brakes because of the first."""
    motion = FakeMotion(DURATION_S)
    task = asyncio.create_task(attended(motion, new_goal()))
    await asyncio.sleep(0.3)
    for _ in range(2):
        task.cancel()
        await asyncio.sleep(STOPPING_S / 4)
    assert not task.done()
    await asyncio.wait((task,))
    assert (task.cancelled(), motion.ended) == (True, True)


@pytest.mark.virtual
async def test_a_listener_that_fails_stops_the_motion() -> None:
    motion, goal = FakeMotion(DURATION_S), new_goal()

    def broken(_message: str) -> None:
        raise ValueError("the listener is broken")

    goal.feedback_listeners.append(broken)
    with pytest.raises(ValueError, match="listener is broken"):
        await attended(motion, goal)
    assert motion.ended
    assert motion.progress < 0.2


@pytest.mark.virtual
async def test_a_device_that_refuses_the_cancel_is_waited_for_all_the_same() -> None:
    motion = DeafMotion(DURATION_S)
    task = asyncio.create_task(attended(motion, new_goal()))
    await asyncio.sleep(0.3)
    task.cancel()
    await asyncio.wait((task,))
    assert (task.cancelled(), motion.progress) == (True, 1.0)


@pytest.mark.virtual
@pytest.mark.parametrize(("reason", "words"), [("motor overheated", "motor overheated"), ("", "gives no reason")])
async def test_a_failure_has_the_devices_reason_as_its_cause(reason: str, words: str) -> None:
    motion = FakeMotion(DURATION_S)
    asyncio.get_running_loop().call_later(0.3, motion.fail, reason)
    with pytest.raises(SkillFailed, match="the arm stopped before the goal") as caught:
        await attended(motion, new_goal())
    assert words in str(caught.value.__cause__)


@pytest.mark.virtual
async def test_a_motion_cancelled_by_somebody_else_is_a_failure_and_by_the_sender_is_none() -> None:
    motion, goal = FakeMotion(DURATION_S), new_goal()
    asyncio.get_running_loop().call_later(0.3, motion.cancel)
    with pytest.raises(SkillFailed, match="the arm was stopped by another command"):
        await attended(motion, goal)
    goal.cancel_requested = True
    motion = FakeMotion(DURATION_S)
    motion.cancel()
    await attended(motion, goal)
    assert motion.ended

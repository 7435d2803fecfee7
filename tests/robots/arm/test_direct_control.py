"""Direct joint control over a fake port: who gets it, what goes through, how it ends."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from engine.bus import GoalStatus, Holder
from engine.errors import LeaseRefused
from engine.skill import Action
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.guiding import GuideArm
from engine.skills.jogging import JogTool
from engine.skills.switch_result import SwitchResult
from tests.robots.arm.served import ELSEWHERE, MOVE, Served, served
from tests.robots.panda_arm import home

GOALS: tuple[Action[Any, Any], ...] = (MOVE, JogTool(), GuideArm())
ON, OFF = SwitchDirectControl(on=True), SwitchDirectControl(on=False)


def say(cell: Served, joints: tuple[float, ...]) -> None:
    """Send a set point."""
    cell.bus.topic("left/direct_joints", JointCommand).publish(JointCommand(position_rad=joints))


@pytest.mark.virtual
async def test_set_points_lead_the_arm_only_while_it_is_on() -> None:
    """Before and after they are ignored."""
    async with served() as cell:
        say(cell, ELSEWHERE)
        assert tuple(cell.port.sample().position_rad) == tuple(home())
        assert await cell.bus.call(ON, to="left") == SwitchResult(success=True, message="direct joint control is on")
        say(cell, ELSEWHERE)
        assert tuple(cell.port.sample().position_rad) == ELSEWHERE
        assert (cell.port.streamed, await cell.mode()) == ([("joint_position", 0.1)], "direct")
        assert await cell.bus.call(OFF, to="left") == SwitchResult(success=True, message="direct joint control is off")
        say(cell, tuple(home()))
        assert (tuple(cell.port.sample().position_rad), await cell.mode()) == (ELSEWHERE, "idle")


@pytest.mark.virtual
async def test_while_it_is_on_every_other_goal_is_rejected_with_the_reason() -> None:
    """And accepted once it is off."""
    async with served() as cell:
        await cell.bus.call(ON, to="left")
        for goal in GOALS:
            end = await cell.bus.send_goal(goal, to="left").result()
            assert end.cause is not None
            assert end.status is GoalStatus.REJECTED
            assert "the arm is in direct joint control" in end.cause.message
        await cell.bus.call(OFF, to="left")
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_it_is_not_turned_on_while_the_arm_does_anything_else() -> None:
    """The answer says what, and the goal goes on."""
    async with served() as cell:
        handle = await cell.begun(MOVE)
        answer = await cell.bus.call(ON, to="left")
        assert not answer.success
        assert "busy with joint_trap_vel" in answer.message
        assert (await handle.result()).status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_it_is_not_turned_on_after_a_reflex() -> None:
    """Recover first."""
    async with served() as cell:
        cell.port.trip("pushed")
        answer = await cell.bus.call(ON, to="left")
        assert not answer.success
        assert "recover_from_error" in answer.message


@pytest.mark.virtual
async def test_switching_twice_is_the_same_as_once() -> None:
    """On and off alike."""
    async with served() as cell:
        for request, words in ((OFF, "is off"), (ON, "is on"), (ON, "is already on"), (OFF, "is off"), (OFF, "is off")):
            answer = await cell.bus.call(request, to="left")
            assert answer == SwitchResult(success=True, message=f"direct joint control {words}")


@pytest.mark.virtual
async def test_it_is_refused_to_others_while_a_run_holds_the_arm_and_ends_with_that_run() -> None:
    """Nobody goes on leading an arm that he does not hold any more."""
    run = Holder("run-1", "root/a")
    async with served() as cell:
        cell.bus.leases.acquire(("left",), run)
        with pytest.raises(LeaseRefused):
            await cell.bus.call(ON, to="left")
        assert (await cell.bus.call(ON, to="left", holder=run)).success
        cell.bus.leases.release_run("run-1")
        await cell.bus.clock.sleep(0.5)
        assert await cell.mode() == "idle"
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_a_stop_of_the_arm_ends_it() -> None:
    """An operator's stop beats everything."""
    async with served() as cell:
        await cell.bus.call(ON, to="left")
        await cell.arm.stop()
        assert (await cell.mode(), cell.stream.ended) == ("idle", True)


@pytest.mark.virtual
async def test_leaving_the_arm_ends_it() -> None:
    """Nothing is left running."""
    async with served() as cell:
        await cell.bus.call(ON, to="left")
    assert cell.stream.ended


@pytest.mark.virtual
async def test_a_set_point_that_does_not_fit_is_left_out_and_named_in_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The next one counts."""
    async with served() as cell:
        await cell.bus.call(ON, to="left")
        with caplog.at_level(logging.WARNING):
            say(cell, (0.1, 0.2))
        say(cell, ELSEWHERE)
        assert cell.stream.sent == [ELSEWHERE]
    assert "left/direct_joints" in caplog.text


@pytest.mark.virtual
async def test_when_the_device_ends_it_the_arm_takes_goals_again_and_says_why_it_ended() -> None:
    """Without anybody turning it off."""
    async with served() as cell:
        await cell.bus.call(ON, to="left")
        cell.stream.fail("panda_joint2 is 0.2 rad behind its set point")
        await cell.bus.clock.sleep(0.1)
        assert await cell.mode() == "idle"
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED

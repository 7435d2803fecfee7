"""Jogging over a fake port: for a time, as told, step by step."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skill import Action
from engine.skills.jogging import JogCommand, JogJoints, JogTool, StepJoints, StepTool
from engine.skills.motion import ForwardKinematics
from tests.robots.arm.served import Served, served
from tests.robots.fake_port import STOPPING_S
from tests.robots.panda_arm import home

TURN = (0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
UP = (0.0, 0.0, 0.02, 0.0, 0.0, 0.0)


def say(cell: Served, velocity: tuple[float, ...]) -> None:
    """Press the key."""
    cell.bus.topic("left/jog", JogCommand).publish(JogCommand(velocity=velocity))


@pytest.mark.virtual
async def test_a_velocity_is_repeated_for_its_time_and_then_the_arm_comes_to_rest() -> None:
    """Often enough for the watchdog."""
    async with served() as cell:
        end = await cell.bus.send_goal(JogJoints(velocity_rad_s=TURN, duration_s=1.0), to="left").result()
        assert cell.port.streamed == [("joint_velocity", 0.2)]
        assert set(cell.stream.sent) == {TURN}
        assert len(cell.stream.sent) >= 19
    assert end.result is not None
    assert end.status is GoalStatus.SUCCEEDED
    assert end.result.duration_s == pytest.approx(1.0 + STOPPING_S, abs=0.02)


@pytest.mark.virtual
async def test_time_in_which_a_jog_is_held_does_not_count() -> None:
    """It goes on for the rest."""
    async with served() as cell:
        handle = await cell.begun(JogJoints(velocity_rad_s=TURN, duration_s=1.0), after_s=0.5)
        await handle.hold()
        await cell.bus.clock.sleep(5.0)
        assert not handle.finished
        await handle.resume()
        end = await handle.result()
    assert end.result is not None
    assert end.result.duration_s == pytest.approx(6.0 + STOPPING_S, abs=0.15)


@pytest.mark.virtual
async def test_without_a_velocity_the_arm_goes_as_the_topic_tells_until_nobody_speaks() -> None:
    """Every message is passed on at once; the goal ends as succeeded after the silence."""
    async with served() as cell:
        handle = await cell.begun(JogTool(watchdog_s=0.15, idle_s=2.0))
        for _ in range(20):
            say(cell, UP)
            await cell.bus.clock.sleep(0.1)
        assert cell.stream.sent == [UP] * 20
        assert await cell.mode() == "jogging"
        assert cell.port.streamed == [("tool_twist", 0.15)]
        end = await handle.result()
    assert end.status is GoalStatus.SUCCEEDED
    assert end.result is not None
    assert end.result.duration_s == pytest.approx(0.2 + 1.9 + 2.0 + STOPPING_S, abs=0.1)


@pytest.mark.virtual
async def test_the_velocity_of_a_tool_is_turned_from_its_own_axes_into_the_world() -> None:
    """Forwards of a hand that points down is down."""
    async with served() as cell:
        goal = JogTool(velocity=(0.0, 0.0, 0.03, 0.0, 0.0, 0.2), frame="tool", duration_s=0.3)
        await cell.bus.send_goal(goal, to="left").result()
        assert np.allclose(cell.stream.sent[0], (0.0, 0.0, -0.03, 0.0, 0.0, -0.2), atol=1e-3)


@pytest.mark.virtual
async def test_a_message_that_does_not_fit_is_left_out_and_named_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    """The jog goes on."""
    async with served() as cell:
        handle = await cell.begun(JogJoints(idle_s=0.5))
        with caplog.at_level(logging.WARNING):
            say(cell, (0.1,))
        say(cell, TURN)
        assert cell.stream.sent == [TURN]
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
    assert "the velocity has 1 components, expected 7" in caplog.text


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (JogJoints(velocity_rad_s=TURN), "a velocity and `duration_s` are only valid together"),
        (JogTool(duration_s=1.0), "a velocity and `duration_s` are only valid together"),
        (JogJoints(velocity_rad_s=(0.1,), duration_s=1.0), "the velocity has 1 components, expected 7"),
        (JogTool(velocity=(float("inf"),) * 6, duration_s=1.0), "is not finite"),
        (StepJoints(step_rad=(0.1,)), "the step has 1 joints"),
        (StepJoints(step_rad=(9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)), "panda_joint1 cannot go to"),
        (StepTool(), "the step is zero"),
        (StepTool(step_m=(0.0, 0.0, 2.0)), ""),
    ],
)
async def test_what_does_not_fit_the_arm_is_rejected(goal: Action[Any, Any], words: str) -> None:
    """Nothing moves."""
    async with served() as cell:
        end = await cell.bus.send_goal(goal, to="left").result()
        assert end.cause is not None
        assert (end.status, cell.port.motion) == (GoalStatus.REJECTED, None)
        assert words in end.cause.message


@pytest.mark.virtual
async def test_a_step_of_joints_adds_to_where_they_are() -> None:
    """Twice the step is twice the way."""
    async with served() as cell:
        await cell.bus.send_goal(StepJoints(step_rad=TURN), to="left").result()
        end = await cell.bus.send_goal(StepJoints(step_rad=TURN), to="left").result()
    assert end.result is not None
    assert np.allclose(end.result.joints, home() + 2 * np.array(TURN), atol=1e-9)


@pytest.mark.virtual
async def test_a_step_of_the_tool_moves_and_turns_it_along_the_axes_asked_for() -> None:
    """1 cm back along its own z, and a turn about it that a second step undoes."""
    async with served() as cell:
        before = await cell.bus.call(ForwardKinematics(), to="left")
        there = StepTool(step_m=(0.0, 0.0, -0.01), turn_rad=(0.0, 0.0, 0.2), frame="tool")
        first = await cell.bus.send_goal(there, to="left").result()
        back = StepTool(step_m=(0.0, 0.0, 0.01), turn_rad=(0.0, 0.0, -0.2), frame="tool")
        second = await cell.bus.send_goal(back, to="left").result()
    assert first.result is not None
    assert second.result is not None
    assert first.result.pose.xyz[2] - before.xyz[2] == pytest.approx(0.01, abs=2e-4)
    turned = 2 * np.arccos(min(1.0, abs(np.dot(first.result.pose.xyzw, before.xyzw))))
    assert turned == pytest.approx(0.2, abs=1e-3)
    assert np.allclose(second.result.pose.xyz, before.xyz, atol=2e-4)


@pytest.mark.virtual
async def test_a_preempted_jog_is_canceled_at_rest_and_the_next_goal_is_accepted_at_once() -> None:
    """Also one that is driven by the topic."""
    for goal in (JogJoints(velocity_rad_s=TURN, duration_s=9.0), JogTool()):
        async with served() as cell:
            handle = await cell.begun(goal)
            handle.cancel()
            assert (await handle.result()).status is GoalStatus.CANCELED
            assert cell.stream.ended
            assert await cell.status_of_next() is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_a_device_that_fails_ends_the_jog_with_its_reason() -> None:
    """And late messages find nobody."""
    async with served() as cell:
        handle = await cell.begun(JogTool())
        cell.stream.fail("panda_joint3 feels 40 Nm")
        end = await handle.result()
        say(cell, UP)
    assert end.cause is not None
    assert (end.status, end.cause.chain()[-1].message) == (GoalStatus.ABORTED, "panda_joint3 feels 40 Nm")


@pytest.mark.virtual
async def test_its_own_velocity_is_no_silence_however_short_the_watchdog() -> None:
    """It is repeated with the feedback, every 50 ms."""
    async with served() as cell:
        await cell.bus.send_goal(JogJoints(velocity_rad_s=TURN, duration_s=0.2, watchdog_s=0.01), to="left").result()
        assert cell.port.streamed == [("joint_velocity", 0.2)]


@pytest.mark.virtual
async def test_a_step_of_more_than_half_a_turn_is_rejected_instead_of_turned_the_other_way() -> None:
    async with served() as cell:
        end = await cell.bus.send_goal(StepTool(turn_rad=(0.0, 0.0, 4.0)), to="left").result()
    assert end.status is GoalStatus.REJECTED
    assert end.cause is not None
    assert end.cause.message == "a step cannot rotate the tool by 4 rad (rotate by less than half a turn)"

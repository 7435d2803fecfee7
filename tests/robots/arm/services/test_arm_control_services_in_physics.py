"""The control services in physics: speed override, reflex and recovery, tool frame, and what preempts what."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.skill import Action
from engine.skills.arm_control import (
    ArmStatus,
    RecoverFromError,
    SetCollisionBehavior,
    SetController,
    SetEndEffectorFrame,
    SetSpeedOverride,
)
from engine.skills.contact import MoveUntilContact
from engine.skills.guiding import GuideArm
from engine.skills.jogging import JogJoints, JogTool, StepJoints, StepTool
from engine.skills.motion import CartLinTask, CartTrapVel
from tests.robots.arm.simulated import HOME, THERE, simulated

DOWN = (1.0, 0.0, 0.0, 0.0)
TURN = (0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
KINDS: list[Action[Any, Any]] = [
    THERE,
    CartTrapVel(pose=Pose(xyz=(-0.1, 0.3, 0.3), xyzw=DOWN), speed=0.5),
    CartLinTask(pose=Pose(xyz=(-0.15, 0.25, 0.3), xyzw=DOWN), duration_s=2.0),
    MoveUntilContact(direction=(0.0, 1.0, 0.0), distance_m=0.2, speed_m_s=0.1),
    JogJoints(velocity_rad_s=TURN, duration_s=5.0),
    JogTool(velocity=(0.0, 0.1, 0.0, 0.0, 0.0, 0.0), duration_s=5.0),
    StepJoints(step_rad=TURN),
    StepTool(step_m=(0.0, 0.1, 0.0), speed_m_s=0.2),
    GuideArm(),
]


@pytest.mark.virtual
async def test_every_kind_of_goal_is_preempted_to_rest_and_the_next_is_accepted_at_once() -> None:
    """RCL 4.3: no emergency state, no restart."""
    async with simulated() as cell:
        for goal in KINDS:
            handle = await cell.begun(goal, after_s=0.4)
            moving = cell.speed_rad_s()
            handle.cancel()
            end = await handle.result()
            name = type(goal).__name__
            assert (end.status, end.result is not None) == (GoalStatus.CANCELED, True), (name, end.cause)
            assert cell.speed_rad_s() < 0.02, name
            assert moving > 0.02 or isinstance(goal, GuideArm), name
            assert (await cell.perform(HOME)).status is GoalStatus.SUCCEEDED, name


@pytest.mark.virtual
async def test_half_the_speed_override_halves_the_measured_speed_also_of_the_motion_under_way() -> None:
    """The path is the same."""
    async with simulated() as cell:
        handle = await cell.begun(THERE, after_s=0.6)
        full = cell.speed_rad_s()
        await cell.bus.call(SetSpeedOverride(share=0.5), to="left")
        await cell.bus.clock.sleep(0.3)
        half = cell.speed_rad_s()
        end = await handle.result()
        slow = await cell.perform(HOME)
        await cell.bus.call(SetSpeedOverride(share=1.0), to="left")
        fast = await cell.perform(THERE)
    assert half == pytest.approx(full / 2, rel=0.1)
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert slow.result is not None
    assert fast.result is not None
    assert slow.result.duration_s == pytest.approx(2 * fast.result.duration_s, rel=0.1)


@pytest.mark.virtual
async def test_an_idle_arm_that_is_pushed_tells_at_once_what_tripped_it() -> None:
    """Within two steps of the world; what is asked of it then is rejected for this reason."""
    async with simulated() as cell:
        await cell.bus.call(SetCollisionBehavior(force_n=20.0), to="left")
        told: list[tuple[float, ArmStatus]] = []
        cell.bus.topic("left/status", ArmStatus).subscribe(lambda status: told.append((cell.bus.clock.now_s(), status)))
        cell.push((0.0, -60.0, 0.0), duration_s=0.3)
        after_s = cell.bus.clock.now_s() + await cell.until(lambda: cell.port.sample().reflex, within_s=0.3)
        ((at_s, status),) = told
        rejected = await cell.perform(HOME)
    assert at_s == pytest.approx(after_s, abs=0.0025)
    assert (status.mode, status.activity) == ("reflex", "")
    assert re.match(r"the arm has stopped by itself: external force limit exceeded: \d+\.\d N > 20 N", status.error)
    assert "> 20 N at the tool" in status.error
    assert rejected.cause is not None
    assert rejected.cause.message.startswith(status.error)


@pytest.mark.virtual
async def test_a_hard_push_trips_the_reflex_and_the_arm_goes_on_after_it_is_recovered() -> None:
    """With the reason in the goal's end, and every goal rejected in between."""
    async with simulated() as cell:
        await cell.bus.call(SetCollisionBehavior(force_n=20.0), to="left")
        handle = await cell.begun(THERE, after_s=0.5)
        cell.push((0.0, -60.0, 0.0), duration_s=0.3)
        end = await handle.result()
        mode = await cell.mode()
        rejected = await cell.perform(HOME)
        rest = cell.speed_rad_s()
        status = await cell.bus.call(RecoverFromError(), to="left")
        after = await cell.perform(HOME)
    assert end.cause is not None
    assert rejected.cause is not None
    assert end.status is GoalStatus.ABORTED
    assert "20" in end.cause.chain()[-1].message
    assert (mode, rejected.status, status.mode) == ("reflex", GoalStatus.REJECTED, "idle")
    assert "recover_from_error" in str(rejected.cause)
    assert rest < 0.02
    assert after.status is GoalStatus.SUCCEEDED, after.cause


@pytest.mark.virtual
async def test_the_tool_really_goes_where_the_end_effector_frame_says() -> None:
    """With the other control law, too."""
    async with simulated() as cell:
        await cell.bus.call(SetController(controller="cartesian_impedance"), to="left")
        await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.02, 0.0, 0.1)), to="left")
        goal = Pose(xyz=(-0.1, 0.2, 0.3), xyzw=DOWN)
        end = await cell.perform(CartTrapVel(pose=goal, speed=0.5))
        await cell.bus.call(SetEndEffectorFrame(xyz_m=(0.0, 0.0, 0.0)), to="left")
        hand = await cell.tool()
    assert end.result is not None
    assert np.allclose(end.result.pose.xyz, goal.xyz, atol=0.002)
    assert np.allclose(hand.xyz, (-0.12, 0.2, 0.4), atol=0.002)

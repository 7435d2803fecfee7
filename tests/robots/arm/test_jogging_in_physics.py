"""Jogging in physics: as fast as told, along the axes asked for, never beyond a limit."""

from __future__ import annotations

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skills.jogging import JogCommand, JogJoints, JogTool, StepTool
from tests.robots.arm.simulated import simulated
from tests.robots.panda_arm import panda_model

LIMITS = panda_model().limits


@pytest.mark.virtual
async def test_the_tool_moves_at_the_commanded_velocity_and_comes_to_rest_when_the_key_is_released() -> None:
    """5 cm/s down for a second; after the release at rest within half a second, and within 1 cm."""
    async with simulated() as cell:
        handle = await cell.begun(JogTool(idle_s=1.0))
        jog = cell.bus.topic("left/jog", JogCommand)
        before = await cell.tool()
        for _ in range(20):
            jog.publish(JogCommand(velocity=(0.0, 0.0, -0.05, 0.0, 0.0, 0.0)))
            await cell.bus.clock.sleep(0.05)
        released = await cell.tool()
        rest_s = await cell.until(lambda: cell.speed_rad_s() < 0.01, within_s=2.0)
        rested = await cell.tool()
        end = await handle.result()
    assert end.status is GoalStatus.SUCCEEDED
    moved = np.subtract(released.xyz, before.xyz)
    assert moved[2] == pytest.approx(-0.05, abs=0.006)
    assert np.abs(moved[:2]).max() < 0.003
    assert rest_s < 0.7
    assert released.xyz[2] - rested.xyz[2] < 0.02


@pytest.mark.virtual
async def test_a_joint_stops_before_its_limit_and_comes_back_from_it() -> None:
    """Told to go on for seconds beyond it."""
    beyond = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.5)
    async with simulated() as cell:
        out = await cell.perform(JogJoints(velocity_rad_s=beyond, duration_s=3.0))
        at_limit = cell.joints()[6]
        back = await cell.perform(JogJoints(velocity_rad_s=tuple(-v for v in beyond), duration_s=0.5))
    assert (out.status, back.status) == (GoalStatus.SUCCEEDED, GoalStatus.SUCCEEDED)
    assert LIMITS.upper_rad[6] - 0.1 < at_limit < LIMITS.upper_rad[6] + 0.005
    assert back.result is not None
    assert back.result.joints[6] < at_limit - 0.3


@pytest.mark.virtual
async def test_at_the_edge_of_its_reach_the_tool_stands_and_no_joint_is_beyond_a_limit() -> None:
    """Through the singularity of the stretched arm."""
    async with simulated() as cell:
        end = await cell.perform(JogTool(velocity=(0.3, 0.0, 0.1, 0.0, 0.0, 0.0), duration_s=5.0))
        joints, speed = cell.joints(), cell.speed_rad_s()
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert (joints > np.array(LIMITS.lower_rad) - 0.005).all()
    assert (joints < np.array(LIMITS.upper_rad) + 0.005).all()
    assert speed < 0.02


@pytest.mark.virtual
async def test_a_step_of_a_millimetre_is_a_millimetre() -> None:
    """Ten of them are a centimetre."""
    async with simulated() as cell:
        before = await cell.tool()
        for _ in range(10):
            end = await cell.perform(StepTool(step_m=(0.0, 0.001, 0.0)))
            assert end.status is GoalStatus.SUCCEEDED, end.cause
        after = await cell.tool()
    assert np.allclose(np.subtract(after.xyz, before.xyz), (0.0, 0.01, 0.0), atol=5e-4)

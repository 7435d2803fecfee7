"""The emulated SoftHand on the hand of a world: it follows its reference, holds by contact, and draws current."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.messages import Pose, Quaternion
from robots.drivers.cell_emulation.world_tool import tool_holds, world_tool
from robots.drivers.softhand.emulation.emulated_hand import CLOSED_TICKS, EmulatedHand
from robots.port import MotionEnd
from robots.scene.sim_scene import PartBody, SimScene
from robots.sim.grip.tool_summary import ToolSummary
from tests.robots.sim.tool_cell import ARM, Reach, block, reaching, scene

# Fingers forward, palm to the left, thumb up; and a configuration in which the arm stands like that.
SIDE: Quaternion = (0.0, 0.70710678, 0.0, 0.70710678)
BESIDE = np.array([0.0, -0.6, -0.2, -2.4, -0.6, 3.4, -2.6])
TOP_M = 0.6
CAN = PartBody(name="can", shape="cylinder", size_m=(0.05, 0.12), mass_kg=0.25, pose=Pose(xyz=(0.5, 0.0, TOP_M + 0.06)))
GRIP_XYZ = (0.509, -0.002, TOP_M + 0.06)
FREE_MA = (60.0, 260.0)
"""Motor current open and closed, on nothing."""
NOISE_MA = 5.0
PRESSES_MA = 22.5
"""As the driver has it: 3 % of its current limit."""

_REST_S = 0.8


def cell(*parts: PartBody) -> SimScene:
    """Return a hand on a Panda, and a pedestal."""
    return scene("panda", "softhand", parts=parts, fixtures=(block("pedestal", (0.5, 0.0, TOP_M), (0.1, 0.1)),))


def summary_of(reach: Reach) -> ToolSummary:
    """Return what the tool is."""
    tool = next(arm.tool for arm in reach.world.host.summary.arms if arm.name == ARM)
    assert tool is not None
    return tool


def holds(reach: Reach) -> bool:
    """Return what a sensor at the tool detects."""
    return tool_holds(reach.world, ARM, summary_of(reach))


def hand_of(reach: Reach) -> EmulatedHand:
    """Return an emulated hand whose tendon is that of the world."""
    tool = summary_of(reach)
    return EmulatedHand(asyncio.get_running_loop().time, world_tool(reach.world, ARM, tool), active=True)


async def lead(hand: EmulatedHand, share: float, *, time_s: float = 1.5) -> int:
    """Move the reference as a driver does, fifty times a second, and wait until the fingers rest.

    Returns how far the motor was behind when the reference had come there.
    """
    begin, steps = hand.reference_ticks, round(50 * time_s)
    for step in range(1, steps + 1):
        hand.follow(round(begin + (share * CLOSED_TICKS - begin) * step / steps))
        await asyncio.sleep(0.02)
    behind_ticks = abs(hand.reference_ticks - hand.position_ticks)
    await asyncio.sleep(_REST_S)
    assert not hand.moving
    return behind_ticks


def extra_ma(hand: EmulatedHand) -> float:
    """Return the current beyond that for closing equally far on nothing."""
    low, high = FREE_MA
    return hand.current_ma - (low + (high - low) * hand.position_ticks / CLOSED_TICKS)


@pytest.mark.virtual
async def test_a_can_is_held_by_contact_and_falls_when_the_hand_opens() -> None:
    x, y, z = GRIP_XYZ
    async with reaching(cell(CAN)) as reach:
        hand = hand_of(reach)
        assert (await reach.to((x, y - 0.1, z), SIDE, duration_s=1.5, like=BESIDE)).end is MotionEnd.REACHED
        assert (await reach.to(GRIP_XYZ, SIDE)).end is MotionEnd.REACHED
        assert not holds(reach)
        await lead(hand, 0.7)
        assert holds(reach)
        assert extra_ma(hand) > PRESSES_MA
        assert hand.position_ticks == pytest.approx(0.7 * CLOSED_TICKS, abs=10)
        await reach.to((x, y, z + 0.1), SIDE)
        await reach.to((x, y - 0.2, z + 0.1), SIDE)
        assert reach.part("can")[0][2] > TOP_M + 0.14
        await lead(hand, 0.0)
        assert not holds(reach)
        await asyncio.sleep(1.0)
        assert reach.part("can")[0][2] < TOP_M - 0.1
        assert (hand.position_ticks, abs(extra_ma(hand)) < NOISE_MA) == (0, True)


@pytest.mark.virtual
async def test_a_hand_on_nothing_follows_its_reference_without_a_stop_and_draws_what_that_takes() -> None:
    async with reaching(cell()) as reach:
        hand = hand_of(reach)
        assert await lead(hand, 0.5, time_s=1.0) < 0.02 * CLOSED_TICKS
        assert hand.position_ticks == pytest.approx(0.5 * CLOSED_TICKS, abs=10)
        assert abs(extra_ma(hand)) < NOISE_MA


@pytest.mark.virtual
async def test_a_motor_that_is_switched_off_stays_where_it_is_and_goes_on_when_it_is_on() -> None:
    async with reaching(cell()) as reach:
        hand = hand_of(reach)
        hand.follow(CLOSED_TICKS)
        await asyncio.sleep(0.3)
        hand.switch(on=False)
        await asyncio.sleep(0.3)
        stopped = hand.position_ticks
        assert (hand.current_ma, hand.moving, 2_000 < stopped < 12_000) == (0, False, True)
        await asyncio.sleep(0.5)
        assert hand.position_ticks == stopped
        hand.activate(on=True)
        await asyncio.sleep(1.5)
        assert hand.position_ticks == CLOSED_TICKS

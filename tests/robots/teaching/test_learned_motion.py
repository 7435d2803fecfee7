"""Teaching in physics: an arm led by hand, its motion learned, and carried out again (mission row T2)."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages.demonstrations import Trajectory
from engine.skills.dmp import CartDMP, JointDMP, LearnCartDmp, LearnJointDmp
from engine.skills.entries import ReadEntry
from engine.skills.guiding import FinishGuiding, GuideArm
from engine.skills.motion import JointTrapVel
from engine.skills.simulated_world import PushBody
from engine.store import SqliteStore, register_store
from engine.store.entry_kinds import decode_entry
from robots.port import Array
from tests.robots.arm.simulated import HOME, Simulated, simulated

PUSHES = ((0.0, 14.0, -4.0), (0.0, -4.0, 8.0))


async def teach(cell: Simulated) -> Trajectory:
    """Push the floating arm to and fro and keep what it did as the entry `led`."""
    await cell.perform(HOME)
    handle = await cell.begun(GuideArm(record="led", damping=0.3), after_s=0.3)
    for force in PUSHES:
        await cell.bus.call(PushBody(body="left/panda_hand", force_n=force, duration_s=0.5), to="cell")
        await cell.bus.clock.sleep(0.5)
    await cell.bus.clock.sleep(1.5)
    await cell.bus.call(FinishGuiding(), to="left")
    end = await handle.result()
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    return decode_entry(await cell.bus.call(ReadEntry(kind="trajectory", name="led"), to="store"), Trajectory)


async def carried_out(cell: Simulated, goal: JointDMP | CartDMP) -> tuple[Array, Array]:
    """The times since the goal began and the measured joints, every five milliseconds."""
    handle = await cell.begun(goal, after_s=0.0)
    times: list[float] = []
    joints: list[Array] = []
    start_s, ended = cell.bus.clock.now_s(), asyncio.ensure_future(handle.result())
    while not ended.done():
        times.append(cell.bus.clock.now_s() - start_s)
        joints.append(cell.joints())
        await cell.bus.clock.sleep(0.005)
    end = await ended
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    return np.array(times), np.array(joints)


@pytest.mark.virtual
async def test_a_motion_led_by_hand_is_learned_and_repeated() -> None:
    """The measured joints stay within 0.02 rad of the demonstration at every instant, 0.005 rad at its end."""
    async with simulated() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        led = await teach(cell)
        learned = await cell.bus.call(LearnJointDmp(entry="led"), to="left")
        cart = await cell.bus.call(LearnCartDmp(entry="led"), to="left")
        await cell.perform(JointTrapVel(joints=learned.dmp.start, speed=0.5))
        times, joints = await carried_out(cell, JointDMP(dmp=learned.dmp))
        await cell.perform(JointTrapVel(joints=learned.dmp.start, speed=0.5))
        await cell.perform(CartDMP(dmp=cart.dmp))
        tool = await cell.tool()
    moved = np.array(led.joints)
    assert np.ptp(moved, axis=0).max() > 0.1
    assert learned.fit.max_rad < 5e-3
    assert cart.fit.max_m < 2e-3
    shown_s = np.array(led.times_s) - learned.fit.cut.start_s
    used = times <= learned.dmp.tau
    for joint in range(7):
        wanted = np.interp(times[used], shown_s, moved[:, joint])
        assert np.abs(joints[used, joint] - wanted).max() < 0.02
    at_end = np.array(led.joints)[np.searchsorted(led.times_s, learned.fit.cut.end_s) - 1]
    assert np.abs(joints[-1] - at_end).max() < 0.005
    assert np.linalg.norm(np.subtract(tool.xyz, cart.dmp.goal[:3])) < 0.003

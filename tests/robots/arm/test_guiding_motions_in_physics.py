"""Guiding in physics: a push moves the arm that otherwise holds itself (mission row R10)."""

from __future__ import annotations

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages.demonstrations import Trajectory
from engine.skills.entries import ReadEntry
from engine.skills.guiding import FinishGuiding, GuideArm
from engine.skills.simulated_world import PushBody
from engine.store import SqliteStore, register_store
from engine.store.entry_kinds import decode_entry
from tests.robots.arm.simulated import HOME, Simulated, simulated

PUSH = PushBody(body="left/panda_hand", force_n=(0.0, 15.0, 0.0), duration_s=0.6)


async def moved_m(cell: Simulated) -> float:
    """How far the tool goes during a push and the second after it."""
    before = await cell.tool()
    await cell.bus.call(PUSH, to="cell")
    await cell.bus.clock.sleep(1.6)
    return float(np.linalg.norm(np.subtract((await cell.tool()).xyz, before.xyz)))


@pytest.mark.virtual
async def test_a_push_moves_the_arm_only_while_it_is_guided_and_it_holds_where_it_was_left() -> None:
    """Without a hand it floats where it is: gravity is compensated."""
    async with simulated() as cell:
        handle = await cell.begun(GuideArm(damping=0.1), after_s=0.5)
        start = await cell.tool()
        await cell.bus.clock.sleep(2.0)
        drift = np.linalg.norm(np.subtract((await cell.tool()).xyz, start.xyz))
        guided = await moved_m(cell)
        await cell.bus.call(FinishGuiding(), to="left")
        end = await handle.result()
        left_at = cell.joints()
        idle = await cell.begun(HOME, after_s=0.0)
        idle.cancel()
        await idle.result()
        held = cell.joints()
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert drift < 0.002
    assert guided > 0.05
    assert np.abs(held - left_at).max() < 0.01


@pytest.mark.virtual
async def test_a_paused_guiding_ends_where_the_arm_is_held() -> None:
    """Led away, held, pushed in vain, finished; the arm stays, and moves again."""
    async with simulated() as cell:
        handle = await cell.begun(GuideArm(damping=0.1), after_s=0.2)
        guided = await moved_m(cell)
        await handle.hold()
        held_at = cell.joints()
        held = await moved_m(cell)
        start_s = cell.bus.clock.now_s()
        await cell.bus.call(FinishGuiding(), to="left")
        took_s = cell.bus.clock.now_s() - start_s
        end = await handle.result()
        left_at = cell.joints()
        back = await cell.perform(HOME)
    assert (end.status, back.status) == (GoalStatus.SUCCEEDED, GoalStatus.SUCCEEDED), (end.cause, back.cause)
    assert took_s < 0.1
    assert guided > 0.05
    assert held < 0.005
    assert np.abs(left_at - held_at).max() < 0.01


@pytest.mark.virtual
async def test_an_arm_that_is_not_guided_gives_way_elastically_only() -> None:
    """The same push while it moves on a path of no length."""
    async with simulated() as cell:
        before = await cell.tool()
        await cell.bus.call(PUSH, to="cell")
        handle = await cell.begun(HOME, after_s=1.6)
        after = await cell.tool()
        await handle.result()
    assert np.linalg.norm(np.subtract(after.xyz, before.xyz)) < 0.005


@pytest.mark.virtual
async def test_what_a_hand_shows_is_recorded_and_the_arm_can_repeat_its_end() -> None:
    """The recorded joints are those that were measured."""
    async with simulated() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        handle = await cell.begun(GuideArm(record="shown", sample_s=0.01), after_s=0.2)
        await moved_m(cell)
        await cell.bus.call(FinishGuiding(), to="left")
        end = await handle.result()
        record = await cell.bus.call(ReadEntry(kind="trajectory", name="shown"), to="store")
        back = await cell.perform(HOME)
    assert end.result is not None
    shown = decode_entry(record, Trajectory)
    assert len(shown.times_s) == end.result.samples > 150
    assert np.allclose(np.diff(shown.times_s), 0.01, atol=2e-3)
    assert np.abs(np.array(shown.joints[-1]) - np.array(end.result.joints)).max() < 0.01
    assert np.linalg.norm(np.subtract(shown.poses[-1][:3], shown.poses[0][:3])) > 0.05
    assert max(abs(wrench[1]) for wrench in shown.wrenches) > 5.0
    assert back.status is GoalStatus.SUCCEEDED, back.cause

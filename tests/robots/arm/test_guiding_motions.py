"""Guiding over a fake port: how it ends, and what of the demonstration is kept."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.errors import EntryNotFound, SkillFailed
from engine.messages.demonstrations import Trajectory
from engine.skills.entries import ReadEntry
from engine.skills.guiding import FinishGuiding, GuideArm, GuideFeedback
from engine.store import SqliteStore, register_store
from engine.store.entry_kinds import decode_entry
from tests.robots.arm.served import Served, served
from tests.robots.fake_port import STOPPING_S
from tests.robots.panda_arm import home


@asynccontextmanager
async def served_with_store() -> AsyncGenerator[Served]:
    """The left arm, and a store on the same bus."""
    async with served() as cell, SqliteStore.open(":memory:", inline=True) as store:
        register_store(cell.bus, store)
        yield cell


async def lead(cell: Served, *, duration_s: float, by_rad: float = 0.3) -> None:
    """Turn the first joint by hand, evenly."""
    steps = round(duration_s / 0.01)
    for step in range(1, steps + 1):
        joints = home()
        joints[0] += by_rad * step / steps
        cell.port.lead_to(tuple(joints.tolist()))
        await asyncio.sleep(0.01)


@pytest.mark.virtual
async def test_guiding_ends_when_it_is_finished_and_the_arm_is_where_it_was_led() -> None:
    """Whoever presses the button."""
    async with served() as cell:
        heard: list[GuideFeedback] = []
        handle = await cell.begun(GuideArm(damping=0.2))
        handle.on_feedback(heard.append)
        assert await cell.mode() == "guiding"
        await lead(cell, duration_s=1.0)
        finished = await cell.bus.call(FinishGuiding(), to="left")
        end = await handle.result()
        assert cell.port.guided == [0.2]
    assert end.result is not None
    assert (end.status, end.result.entry, end.result.samples) == (GoalStatus.SUCCEEDED, "", 0)
    assert end.result.joints == finished.joints
    assert end.result.joints[0] - home()[0] == pytest.approx(0.3)
    assert heard[-1].joints == end.result.joints


@pytest.mark.virtual
async def test_guiding_ends_after_its_duration_not_counting_pauses() -> None:
    """One second, and three held."""
    async with served() as cell:
        handle = await cell.begun(GuideArm(duration_s=1.0), after_s=0.5)
        await handle.hold()
        await cell.bus.clock.sleep(3.0)
        await handle.resume()
        end = await handle.result()
    assert end.result is not None
    assert end.result.duration_s == pytest.approx(4.0 + STOPPING_S, abs=0.12)


@pytest.mark.virtual
async def test_what_was_shown_is_written_to_the_store_as_a_trajectory() -> None:
    """Joints, tool poses and wrenches over time, evenly sampled."""
    async with served_with_store() as cell:
        cell.port.wrench = np.array([0.0, 0.0, -3.0, 0.0, 0.0, 0.0])
        handle = await cell.begun(GuideArm(record="demo/lift", sample_s=0.02), after_s=0.1)
        await lead(cell, duration_s=1.0)
        await cell.bus.call(FinishGuiding(), to="left")
        end = await handle.result()
        record = await cell.bus.call(ReadEntry(kind="trajectory", name="demo/lift"), to="store")
    assert end.result is not None
    shown = decode_entry(record, Trajectory)
    assert (end.result.entry, end.result.samples) == ("demo/lift", len(shown.times_s))
    assert len(shown.times_s) == pytest.approx((1.1 + STOPPING_S) / 0.02, abs=3)
    assert np.allclose(np.diff(shown.times_s), 0.02, atol=1e-5)
    assert shown.joints[0] == pytest.approx(home(), abs=1e-6)
    assert shown.joints[-1][0] - shown.joints[0][0] == pytest.approx(0.3, abs=1e-5)
    assert shown.poses[-1][:3] == pytest.approx(end.result.pose.xyz, abs=1e-5)
    assert shown.wrenches[3] == (0.0, 0.0, -3.0, 0.0, 0.0, 0.0)
    assert shown.names == cell.port.joint_names


@pytest.mark.virtual
async def test_a_pause_leaves_no_gap_in_the_demonstration() -> None:
    """Time in which the goal is held is left out."""
    async with served_with_store() as cell:
        handle = await cell.begun(GuideArm(record="demo", sample_s=0.02), after_s=0.5)
        await handle.hold()
        await cell.bus.clock.sleep(10.0)
        await handle.resume()
        await cell.bus.clock.sleep(0.5)
        await cell.bus.call(FinishGuiding(), to="left")
        await handle.result()
        record = await cell.bus.call(ReadEntry(kind="trajectory", name="demo"), to="store")
    times = decode_entry(record, Trajectory).times_s
    assert np.diff(times).max() < 0.05
    assert times[-1] == pytest.approx(1.0 + STOPPING_S, abs=0.1)


@pytest.mark.virtual
async def test_a_paused_guiding_can_be_finished_and_what_was_shown_before_is_kept() -> None:
    """Nobody has to resume it first; the next goal is accepted at once."""
    async with served_with_store() as cell:
        handle = await cell.begun(GuideArm(record="demo", sample_s=0.02), after_s=0.5)
        await handle.hold()
        await cell.bus.clock.sleep(2.0)
        await cell.bus.call(FinishGuiding(), to="left")
        end = await handle.result()
        record = await cell.bus.call(ReadEntry(kind="trajectory", name="demo"), to="store")
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED
    assert end.status is GoalStatus.SUCCEEDED
    assert decode_entry(record, Trajectory).times_s[-1] == pytest.approx(0.5, abs=0.1)


@pytest.mark.virtual
async def test_a_cancelled_demonstration_is_not_kept() -> None:
    """And the next goal is accepted at once."""
    async with served_with_store() as cell:
        handle = await cell.begun(GuideArm(record="demo"), after_s=0.5)
        handle.cancel()
        end = await handle.result()
        assert end.result is not None
        assert (end.status, end.result.entry) == (GoalStatus.CANCELED, "")
        with pytest.raises(EntryNotFound, match="demo"):
            await cell.bus.call(ReadEntry(kind="trajectory", name="demo"), to="store")
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (GuideArm(record="Demo 1"), "'Demo 1' cannot be the name of an entry"),
        (GuideArm(record="demo", duration_s=600.0, sample_s=0.01), "do not fit into an entry"),
    ],
)
async def test_a_demonstration_that_could_not_be_stored_is_rejected_beforehand(goal: GuideArm, words: str) -> None:
    """Not after the work."""
    async with served_with_store() as cell:
        end = await cell.bus.send_goal(goal, to="left").result()
        assert end.cause is not None
        assert (end.status, cell.port.guided) == (GoalStatus.REJECTED, [])
        assert words in end.cause.message


@pytest.mark.virtual
async def test_without_a_store_recording_is_rejected_and_guiding_is_not() -> None:
    """A cell may have none."""
    async with served() as cell:
        refused = await cell.bus.send_goal(GuideArm(record="demo"), to="left").result()
        guided = await cell.bus.send_goal(GuideArm(duration_s=0.2), to="left").result()
    assert (refused.status, guided.status) == (GoalStatus.REJECTED, GoalStatus.SUCCEEDED)


@pytest.mark.virtual
async def test_there_is_nothing_to_finish_when_nobody_guides() -> None:
    """The button does nothing, and says so."""
    async with served() as cell:
        with pytest.raises(SkillFailed, match="the arm is not being guided"):
            await cell.bus.call(FinishGuiding(), to="left")

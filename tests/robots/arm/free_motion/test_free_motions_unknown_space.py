"""Planned motions through space that no camera has seen: refused, gone around, slow, delayed or accepted."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.document.cell_perception import UnknownSpacePolicy
from engine.messages.sensing import CameraStatus
from engine.skills.planning import MotionTarget, PlanMotion
from robots.planning.swept_space import CoverRegion
from robots.workspace.unknown_space import SLOW_SPEED, UnknownSpaceRule
from tests.robots.workspace.fake_cell import FakeCell, fake_cell
from tests.robots.workspace.free_cell import ACROSS, THERE, free

PILLAR = ((-0.1, 0.05, 0.1), (0.0, 0.15, 0.75))
"""Between THERE and ACROSS, with a path around it."""
HALF = ((-0.6, -0.6, 0.1), (0.6, 0.0, 0.9))
"""All that is mapped on the side of ACROSS."""


def rule(policy: UnknownSpacePolicy, *regions: CoverRegion) -> UnknownSpaceRule:
    """Return the rule of a cell."""
    return UnknownSpaceRule(policy=policy, regions=regions)


async def start(cell: FakeCell) -> None:
    """Go where the motions begin, through seen space."""
    cell.cameras.see_all_but()
    end = await cell.bus.send_goal(free(THERE, speed=1.0), to="left").result()
    assert end.status is GoalStatus.SUCCEEDED, end.cause


@pytest.mark.virtual
async def test_a_motion_through_unknown_space_is_refused_with_place_cameras_and_remedy() -> None:
    async with fake_cell(unknown_space=rule("refuse")) as cell:
        await start(cell)
        before = len(cell.port.followed)
        cell.cameras.camera_statuses = (CameraStatus(time_s=0.0, camera="top", condition="healthy"),)
        cell.cameras.see_all_but(HALF)
        end = await cell.bus.send_goal(free(ACROSS), to="left").result()
        assert (end.status, len(cell.port.followed)) == (GoalStatus.REJECTED, before)
        text = str(end.cause)
        for words in ("left would pass through", "l of unknown space, first at (", "has never been seen"):
            assert words in text
        for words in ("camera top does not see it", "clear the view of the cameras", "`unknown_space`"):
            assert words in text


@pytest.mark.virtual
async def test_a_path_around_unknown_space_is_taken_where_there_is_one() -> None:
    async with fake_cell(unknown_space=rule("refuse")) as cell:
        await start(cell)
        cell.cameras.see_all_but(PILLAR)
        end = await cell.bus.send_goal(free(ACROSS), to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        straight = np.array(ACROSS) - np.array(THERE)
        path = cell.port.followed[-1].position_rad - np.array(THERE)
        along = (path @ straight)[:, None] / (straight @ straight)
        assert np.abs(path - along * straight).max() > 0.05


@pytest.mark.virtual
async def test_with_regions_only_space_inside_them_counts() -> None:
    elsewhere = CoverRegion(name="shelf", center_m=(-0.4, 0.4, 0.2), size_m=(0.1, 0.1, 0.1))
    bench = CoverRegion(name="bench", center_m=(0.0, -0.3, 0.5), size_m=(1.2, 0.6, 0.8))
    for region, status in ((elsewhere, GoalStatus.SUCCEEDED), (bench, GoalStatus.REJECTED)):
        async with fake_cell(unknown_space=rule("refuse", region)) as cell:
            await start(cell)
            cell.cameras.see_all_but(HALF)
            end = await cell.bus.send_goal(free(ACROSS), to="left").result()
            assert end.status is status, end.cause
            if end.cause is not None:
                assert "unknown space in bench" in str(end.cause)


@pytest.mark.virtual
async def test_slow_moves_through_it_at_the_slow_speed() -> None:
    async with fake_cell(unknown_space=rule("slow")) as cell:
        await start(cell)
        times: list[float] = []
        for boxes, target in (((), ACROSS), ((), THERE), ((HALF,), ACROSS)):
            cell.cameras.see_all_but(*boxes)
            end = await cell.bus.send_goal(free(target, speed=0.5), to="left").result()
            assert end.result is not None, end.cause
            times.append(end.result.duration_s)
        assert times[2] > 0.7 * times[0] * 0.5 / SLOW_SPEED


@pytest.mark.virtual
async def test_look_first_waits_until_it_is_seen_and_refuses_what_stays_unknown() -> None:
    async with fake_cell(unknown_space=rule("look_first")) as cell:
        await start(cell)
        cell.cameras.see_all_but(HALF)
        handle = cell.bus.send_goal(free(ACROSS), to="left")
        await cell.bus.clock.sleep(1.0)
        waited = not cell.moves()
        cell.cameras.see_all_but()
        end = await handle.result()
        assert (waited, end.status) == (True, GoalStatus.SUCCEEDED), end.cause
        cell.cameras.see_all_but(((-0.6, 0.0, 0.1), (0.6, 0.6, 0.9)))
        refused = await cell.bus.send_goal(free(THERE), to="left").result()
        assert refused.status is GoalStatus.REJECTED
        assert "unknown space" in str(refused.cause)


@pytest.mark.virtual
async def test_accept_asks_nothing() -> None:
    async with fake_cell(unknown_space=rule("accept")) as cell:
        await start(cell)
        cell.cameras.see_all_but(HALF)
        end = await cell.bus.send_goal(free(ACROSS), to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause


@pytest.mark.virtual
async def test_a_plan_through_unknown_space_fails_with_the_same_reason() -> None:
    async with fake_cell(unknown_space=rule("refuse")) as cell:
        await start(cell)
        cell.cameras.see_all_but(HALF)
        end = await cell.bus.send_goal(PlanMotion(target=MotionTarget(joints=ACROSS)), to="left").result()
        assert end.status is GoalStatus.ABORTED
        assert "unknown space" in str(end.cause)


@pytest.mark.virtual
async def test_an_unhealthy_camera_stops_an_adaptive_motion_and_keeps_the_next_one_from_starting() -> None:
    covered = CameraStatus(time_s=1.0, camera="top", condition="covered", cause="all is nearer than 0.2 m")
    async with fake_cell() as cell:
        await start(cell)
        handle = await cell.begun(free(ACROSS, speed=0.3, patience_s=1.0))
        assert cell.moves()
        cell.cameras.camera_statuses = (covered,)
        cell.cameras.see()
        end = await handle.result()
        assert end.status is GoalStatus.ABORTED
        assert "camera top is covered: all is nearer than 0.2 m" in str(end.cause)
        async with asyncio.timeout(20.0):
            again = await cell.bus.send_goal(free(THERE), to="left").result()
        assert again.status is GoalStatus.REJECTED
        assert "camera top is covered" in str(again.cause)

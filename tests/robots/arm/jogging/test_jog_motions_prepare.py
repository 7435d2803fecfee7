"""An arm is prepared once for all who ask meanwhile."""

from __future__ import annotations

import asyncio

import pytest

from engine.errors import SkillFailed
from engine.skills.jogging import JogReady, PrepareJog
from tests.robots.workspace.fake_cell import FakeCell, fake_cell


def prepare(cell: FakeCell) -> asyncio.Task[JogReady]:
    return asyncio.create_task(cell.bus.call(PrepareJog(), to="left"))


@pytest.mark.virtual
async def test_requests_that_come_together_share_one_preparation() -> None:
    """Those that come while one is under way share the next: it began before them, in a scene that may have changed."""
    async with fake_cell() as cell:
        cell.planner.silent_s = 0.2
        first = prepare(cell)
        await cell.bus.clock.sleep(0.1)
        later = [prepare(cell) for _ in range(5)]
        await asyncio.gather(first, *later)
        assert cell.planner.checks == 2


@pytest.mark.virtual
async def test_a_preparation_that_fails_is_tried_again_for_each_request() -> None:
    async with fake_cell() as cell:
        cell.planner.failing = "the planning process is gone"
        found = await asyncio.gather(prepare(cell), prepare(cell), return_exceptions=True)
        assert [type(each) for each in found] == [SkillFailed, SkillFailed]
        cell.planner.failing = ""
        await prepare(cell)

"""Which contacts of a path may be gone when the arm arrives: those with other arms, and with what these hold."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.skills.planning_scene import AttachPart
from robots.arm.scene_queries.path_guard import PathGuard
from tests.robots.workspace.free_cell import ACROSS, THERE, free_cell


@pytest.mark.virtual
async def test_another_arm_and_what_it_holds_may_leave_also_on_its_reserved_path_and_a_fixture_may_not(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.bus.call(AttachPart(part="hca_north", robot="left"), to="cell")
        opened.workspace.claim("left", (THERE, ACROSS))
        guard, own = PathGuard("right", opened.workspace), "right/panda_hand"
        for leaves in ("left/panda_hand", "left~1/panda_hand", "hca_north", "hca_north~1"):
            assert guard.is_other_arm(((own, leaves),)), leaves
        for stays in ("table", "hca_south"):
            assert not guard.is_other_arm(((own, stays),)), stays
        assert not guard.is_other_arm(((own, "left/panda_hand"), (own, "table")))

"""The contacts of an arm are known with its fingers as they will be, before they open or close."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.skills.gripper import GripperMove, GripperOpen
from engine.skills.motion import CartLinTask, CartTrapVel, InverseKinematics
from engine.skills.planning_scene import CheckCollision
from robots.planning.scene.planning_scene import NamePair
from tests.robots.workspace.free_cell import FreeCell, free_cell

DOWN = (1.0, 0.0, 0.0, 0.0)
BESIDE_M = 0.062
"""From the middle of the closed fingers to that of the part: between them is room, but not for an open finger."""


async def contacts(opened: FreeCell, pose: Pose, *openings_m: float) -> set[NamePair]:
    """Return what the right arm would touch of the part beside it."""
    joints = (await opened.bus.call(InverseKinematics(pose=pose), to="right")).joints
    request = CheckCollision(robot="right", joints=joints, openings_m=openings_m)
    report = await opened.bus.call(request, to="cell")
    return {(pair.first, pair.second) for pair in report.touching}


@pytest.mark.virtual
async def test_a_finger_that_opens_beside_a_part_is_reported_before_it_pushes_the_part(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        x, y, _ = (0.11, -0.28, 0.0)
        beside = Pose(xyz=(x, y + BESIDE_M, 0.028), xyzw=DOWN)
        above = Pose(xyz=(x, y + BESIDE_M, 0.15), xyzw=DOWN)
        closed = await opened.bus.send_goal(GripperMove(width_m=0.01), to="right/gripper").result()
        assert closed.status is GoalStatus.SUCCEEDED, closed.cause
        for goal in (CartTrapVel(pose=above, speed=0.3), CartLinTask(pose=beside, duration_s=2.0)):
            end = await opened.bus.send_goal(goal, to="right").result()
            assert end.status is GoalStatus.SUCCEEDED, end.cause
        assert (await contacts(opened, beside), opened.touching("right")) == (set(), "")
        reported = await contacts(opened, beside, 0.01, 0.04, 1.0)
        assert any("finger" in pair[0] and pair[1] == "hca_south" for pair in reported), reported
        await opened.bus.send_goal(GripperOpen(), to="right/gripper").result()
        assert "hca_south" in opened.touching("right")

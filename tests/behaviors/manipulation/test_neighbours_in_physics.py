"""A part is not taken where a finger that closes would push what stands beside it: known before the arm goes down."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.document import load_cell
from engine.event import GoalSent
from engine.messages import PartPoses, Pose
from engine.skills.gripper import GripperGrasp, GripperOpen
from engine.skills.motion import CartLinTask, CartTrapVel
from tests.behaviors.manipulation.test_parts_in_physics import PANDA_HAND, ended, run

PANEL_Y_M = 0.31
CELL = f"""
flexcell: 1
cell: neighbours
world: {{kind: mujoco, step_s: 0.001}}
robots:
  left: {{model: panda, base: {{xyz: [-0.55, 0, 0]}}, gripper: {{model: panda_hand}}}}
fixtures:
  table: {{shape: box, size_m: [1.6, 1.2, 0.04], at: {{xyz: [0, 0, -0.02]}}}}
parts:
  hca_north: {{shape: box, size_m: [0.06, 0.03, 0.04], mass_kg: 0.12, at: {{xyz: [-0.11, 0.28, 0.02]}}}}
  panel: {{shape: box, size_m: [0.06, 0.006, 0.04], mass_kg: 0.05, at: {{xyz: [-0.11, {PANEL_Y_M}, 0.02]}}}}
"""
"""The panel stands inside of the open fingers, 12 mm beside the part: a finger that closes comes to there."""
DOWN = (1.0, 0.0, 0.0, 0.0)


def written(folder: Path) -> Path:
    """Write the cell."""
    file = folder / "cell.yaml"
    file.write_text(CELL.lstrip(), encoding="utf-8")
    return file


def test_a_finger_that_would_close_onto_a_neighbour_blocks_the_pick_and_nothing_is_moved(tmp_path: Path) -> None:
    ran = run(tmp_path, written(tmp_path), PANDA_HAND)
    assert ran.result.cause is not None
    why = ran.result.cause.chain()[-1].message
    moved = [event for event in ran.events if isinstance(event, GoalSent) and "cart_lin_task" in event.address]
    assert (ran.outcome, "finger" in why, "panel" in why, moved) == ("blocked", True, True, []), ended(ran)


@pytest.mark.virtual
async def test_the_open_fingers_have_room_there_and_push_the_neighbour_as_they_close(tmp_path: Path) -> None:
    """What the pick is blocked for is what happens in physics."""
    async with OpenCell(load_cell(written(tmp_path)), store_path=str(tmp_path / "store.db")) as cell:
        await cell.bus.send_goal(GripperOpen(), to="left/gripper").result()
        for goal in (
            CartTrapVel(pose=Pose(xyz=(-0.11, 0.28, 0.2), xyzw=DOWN), speed=0.5),
            CartLinTask(pose=Pose(xyz=(-0.11, 0.28, 0.028), xyzw=DOWN), duration_s=3.0),
        ):
            end = await cell.bus.send_goal(goal, to="left").result()
            assert end.status is GoalStatus.SUCCEEDED, end.cause
        before = panel_y_m(cell)
        await cell.bus.send_goal(GripperGrasp(width_m=0.03, force_n=30.0), to="left/gripper").result()
        assert before == pytest.approx(PANEL_Y_M, abs=0.001)
        assert panel_y_m(cell) < before - 0.005


def panel_y_m(cell: OpenCell) -> float:
    """Return where the panel is across the fingers."""
    parts = cell.bus.topic("cell/parts", PartPoses).latest
    assert parts is not None
    return parts.poses["panel"].xyz[1]

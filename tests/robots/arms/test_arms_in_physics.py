"""Every shipped arm with its tool stands still at home, moves where it is told, and stands still there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.messages import JointState, RobotDescription
from engine.skills.motion import JointTrapVel
from robots.model.registry import robot_model
from robots.port import Array

CELL = """flexcell: 1
cell: bench
world: {{kind: mujoco}}
robots:
  arm: {{model: {arm}, gripper: {{model: {tool}}}{options}}}
"""


def measured(cell: OpenCell) -> Array:
    """Return the joints."""
    state = cell.bus.topic("arm/joint_state", JointState).latest
    assert state is not None
    return np.array(state.position_rad)


@pytest.mark.parametrize(
    ("arm", "tool", "options"),
    [
        ("panda", "softhand", ""),
        ("ur10", "robotiq_2f85", ", calibration: ./ur10.yaml"),
        ("irb4600", "magnet", ", coupled_joints: true"),
        ("servo_arm", "servo_claw", ""),
    ],
)
def test_an_arm_with_its_tool_holds_and_moves(tmp_path: Path, arm: str, tool: str, options: str) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL.format(arm=arm, tool=tool, options=options))
    printed = robot_model("ur10").licence_file.parent / "ur10_calibration.yaml"
    (tmp_path / "ur10.yaml").write_text(printed.read_text())
    model = robot_model(arm, gripper=tool)
    home = np.array(model.home_rad)
    goal = home + np.resize((0.3, -0.2), model.dof)

    async def scenario() -> tuple[Array, Array, str]:
        async with OpenCell(load_cell(file)) as cell:
            await cell.bus.clock.sleep(0.5)
            held = measured(cell)
            end = await cell.bus.send_goal(JointTrapVel(joints=tuple(goal.tolist()), speed=0.5), to="arm").result()
            assert end.status is GoalStatus.SUCCEEDED, end.cause
            await cell.bus.clock.sleep(0.3)
            description = cell.bus.topic("arm/description", RobotDescription).latest
            assert description is not None
            return held, measured(cell), description.calibration

    held, reached, calibration = run_virtual(scenario())
    assert np.abs(held - home).max() < 0.002
    assert np.abs(reached - goal).max() < 0.002
    assert bool(calibration) == ("calibration" in options)

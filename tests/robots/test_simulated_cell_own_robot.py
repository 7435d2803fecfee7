"""A robot that is only a folder beside the cell document is simulated, moved and described."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.errors import CellError, FlexcellError
from engine.messages import JointState, RobotDescription, SceneDescription
from engine.skills.motion import JointTrapVel

EXAMPLES = Path(__file__).parents[2] / "docs" / "how-to" / "examples"


@pytest.fixture(name="cell_file")
def _cell_file(tmp_path: Path) -> Path:
    """Put the example's folder and cell where a user has theirs."""
    shutil.copytree(EXAMPLES / "lifter", tmp_path / "lifter")
    return Path(shutil.copy(EXAMPLES / "lifter_cell.yaml", tmp_path / "cell.yaml"))


async def scenario(cell_file: Path) -> tuple[JointState, RobotDescription, SceneDescription]:
    """Move the arm and return where it stands and what is said of it."""
    async with OpenCell(load_cell(cell_file)) as cell:
        end = await cell.bus.send_goal(JointTrapVel(joints=(0.8, -0.4), speed=0.5), to="lifter").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        state = cell.bus.topic("lifter/joint_state", JointState).latest
        description = cell.bus.topic("lifter/description", RobotDescription).latest
        scene = cell.bus.topic("cell/scene", SceneDescription).latest
    assert state is not None
    assert description is not None
    assert scene is not None
    return state, description, scene


def test_a_folder_beside_the_cell_is_a_robot_that_moves(cell_file: Path) -> None:
    state, description, scene = run_virtual(scenario(cell_file))
    assert np.allclose(state.position_rad, (0.8, -0.4), atol=0.01)
    assert (description.model, description.licence) == ("lifter", "CC0-1.0")
    assert (description.tool, description.tool_kind) == ("servo_claw", "claw")
    assert "servo_claw_left_finger" in description.urdf
    assert description.effort_nm == (60.0, 80.0)
    drawn = {geometry.frame for geometry in scene.geometries}
    assert {"lifter/foot", "lifter/column", "lifter/beam", "lifter/servo_claw_base"} <= drawn


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("lifter/robot.yaml", "name: lift,", "name: lit,", r"robot\.yaml:\d+:\d+: the URDF has no joint lit "),
        ("cell.yaml", "./lifter", "./lifted", "there is no robot.yaml in .*lifted"),
        ("cell.yaml", "{model: servo_claw}", "{model: servo_paw}", "did you mean servo_claw"),
        ("cell.yaml", "driver: sim", "driver: sim\n    coupled_joints: true", "the joints of lifter are not coupled"),
    ],
)
def test_what_is_wrong_with_it_is_said_when_the_cell_is_opened(
    cell_file: Path, file: str, old: str, new: str, words: str
) -> None:
    changed = cell_file.parent / file
    changed.write_text(changed.read_text().replace(old, new))
    with pytest.raises(FlexcellError, match=words):
        run_virtual(scenario(cell_file))


def test_a_calibration_beside_the_cell_is_applied(cell_file: Path) -> None:
    """And one for an arm that knows none is refused."""
    cell_file.write_text(cell_file.read_text().replace("driver: sim", "driver: sim\n    calibration: ./mine.yaml"))
    with pytest.raises(CellError, match="lifter does not support calibration files"):
        run_virtual(scenario(cell_file))

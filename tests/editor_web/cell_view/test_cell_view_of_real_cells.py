"""What is drawn of planned ways fits the arms of the cells that come with the project, from the bus alone."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

import numpy as np
import pytest

from editor_web.cell_view.rendering.transforms import Matrix, matrix_of_pose, poses_by_frame
from editor_web.cell_view.rendering.urdf_tree import UrdfTree
from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import FramePoses, JointState, RobotDescription, SceneDescription
from engine.skills.planning import MotionTarget, PathPreview, PlanMotion

CELLS = Path(__file__).parents[3] / "behaviors" / "cells"
M = TypeVar("M")


def latest(bus: SkillBus, topic: str, kind: type[M]) -> M:
    """The newest message of a topic."""
    found = bus.topic(topic, kind).latest
    assert found is not None
    return found


def frames_of(bus: SkillBus, arm: str) -> dict[str, Matrix]:
    """Where the links of an arm are."""
    poses = poses_by_frame(latest(bus, "cell/frames", FramePoses))
    return {name.partition("/")[2]: matrix_of_pose(pose) for name, pose in poses.items() if name.startswith(f"{arm}/")}


@pytest.mark.virtual
@pytest.mark.parametrize("name", ["dual_panda", "ur10", "irb4600", "servo_arm"])
async def test_the_ghost_of_an_arm_at_its_measured_joints_is_the_arm(name: str, tmp_path: Path) -> None:
    """Every body that is drawn of it, tool and fingers included, up to noise and the error of the base."""
    async with OpenCell(load_cell(CELLS / f"{name}.yaml"), store_path=str(tmp_path / "store.db")) as cell:
        scene = latest(cell.bus, "cell/scene", SceneDescription)
        topics = [each.name for each in cell.bus.listing() if each.type == RobotDescription.__name__]
        assert topics
        for topic in topics:
            arm = latest(cell.bus, topic, RobotDescription)
            joints = latest(cell.bus, f"{arm.name}/joint_state", JointState)
            at = dict(zip(joints.names, joints.position_rad, strict=True))
            seen = frames_of(cell.bus, arm.name)
            links = UrdfTree(arm.urdf).links(matrix_of_pose(arm.base), at, seen=seen)
            drawn = {g.frame.partition("/")[2] for g in scene.geometries if g.frame.startswith(f"{arm.name}/")}
            assert drawn
            assert {link: np.allclose(links[link], seen[link], atol=2e-3) for link in drawn} == dict.fromkeys(
                drawn, True
            )


@pytest.mark.virtual
async def test_a_proposed_way_begins_where_the_tool_is(tmp_path: Path) -> None:
    async with OpenCell(load_cell(CELLS / "ur10.yaml"), store_path=str(tmp_path / "store.db")) as cell:
        arm = latest(cell.bus, "arm/description", RobotDescription)
        now = latest(cell.bus, "arm/joint_state", JointState).position_rad
        goal = (now[0] + 0.4, *now[1:])
        end = await cell.bus.send_goal(PlanMotion(target=MotionTarget(joints=goal)), to="arm").result()
        assert end.cause is None
        preview = latest(cell.bus, "arm/planned_path", PathPreview)
        assert preview.state == "proposed"
        tool = frames_of(cell.bus, "arm")
        linkage = UrdfTree(arm.urdf)
        for joints, point in zip(preview.joints, preview.tool_path, strict=True):
            at = dict(zip(preview.joint_names, joints, strict=True))
            links = linkage.links(matrix_of_pose(arm.base), at, seen=tool)
            assert np.allclose(links[arm.tool_frame.partition("/")[2]][:3, 3], point, atol=1e-6)
        assert np.allclose(preview.joints[0], now, atol=1e-2)
        assert np.allclose(preview.joints[-1], goal, atol=1e-6)

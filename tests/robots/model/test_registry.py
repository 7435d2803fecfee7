"""The registry: every arm takes every tool, names are near, edited folders are read again."""

from __future__ import annotations

import shutil
import xml.etree.ElementTree as ET
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from engine.errors import CellError
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.mechanics.pinocchio_model import arm_model
from robots.model.registry import ARMS_DIR, OWN_TOOL, model_by_name, robot_model, robot_names, tool_names
from robots.model.transform import RigidTransform
from robots.sim.physics.arm_spec import arm_spec

ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def test_the_arms_and_tools_of_the_documents_are_there() -> None:
    assert robot_names() == ("fr3", "irb4600", "panda", "servo_arm", "ur10")
    assert tool_names() == ("magnet", "panda_hand", "robotiq_2f85", "servo_claw", "softhand")


@pytest.mark.parametrize(("arm", "tool"), list(product(robot_names(), (None, *tool_names()))))
def test_every_arm_takes_every_tool_in_kinematics_and_in_physics(arm: str, tool: str | None) -> None:
    model = robot_model(arm, gripper=tool)
    names = {element.attrib["name"] for element in ET.fromstring(model.urdf_text)}
    used = {model.base_link, model.flange_link, model.tool_link, *model.arm_joints}
    used |= {link for pair in model.allowed_collisions for link in pair}
    if model.tool is not None:
        used |= {model.tool.root_link, *model.tool.links, *model.tool.joints}
    assert used <= names
    assert arm_model(model).nq == model.dof
    compiled = arm_spec(model).compile()
    assert compiled.nq == model.dof + (len(model.tool.joints) if model.tool is not None else 0)
    assert compiled.body(model.tool_link).id > 0


@pytest.mark.parametrize("name", [*robot_names()])
def test_every_arm_rests_within_its_limits_and_comes_with_its_licence(name: str) -> None:
    model = robot_model(name)
    limits = model.limits
    for lower, home, upper in zip(limits.lower_rad, model.home_rad, limits.upper_rad, strict=True):
        assert lower <= home <= upper
    assert model.licence
    assert model.licence_file.stat().st_size > 500
    if model.tool is not None:
        assert model.tool.licence_file.is_file()


def test_an_arm_comes_with_its_own_tool_unless_another_is_named() -> None:
    assert model_by_name("panda") is robot_model("panda", gripper=OWN_TOOL)
    assert robot_model("panda") == robot_model("panda", gripper="panda_hand")
    assert robot_model("panda", gripper=None).tool is None
    assert robot_model("ur10").tool is None


def test_without_a_tool_the_tool_centre_point_is_the_flange() -> None:
    bare, held = (ArmKinematics(robot_model("ur10", gripper=g), base=ORIGIN) for g in (None, "robotiq_2f85"))
    home = np.array(bare.model.home_rad)
    flange = bare.tool_pose(home)
    expected = flange.then(RigidTransform.of((0.0, 0.0, 0.171), (0.0, 0.0, np.sin(np.pi / 4), np.cos(np.pi / 4))))
    assert held.tool_pose(home).distance_m(expected) < 1e-9
    assert held.tool_pose(home).angle_rad(expected) < 1e-6


@pytest.mark.parametrize(
    ("name", "gripper", "words"),
    [
        ("ur01", None, "there is no robot model ur01 .did you mean ur10"),
        ("panda", "robotiq_2f_85", "there is no gripper model robotiq_2f_85 .did you mean robotiq_2f85"),
        ("./nowhere", None, "there is no robot.yaml in nowhere"),
    ],
)
def test_an_unknown_name_is_refused_with_the_near_one(name: str, gripper: str | None, words: str) -> None:
    with pytest.raises(CellError, match=words):
        robot_model(name, gripper=gripper)


def test_a_folder_with_a_tool_is_not_taken_for_a_robot() -> None:
    with pytest.raises(CellError, match=r"no robot\.yaml .*it has a tool\.yaml"):
        robot_model(str(ARMS_DIR.parent / "tools" / "magnet"))


def test_a_model_is_made_once_and_again_after_its_folder_was_edited(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(ARMS_DIR / "irb4600", folder)
    document = folder / "robot.yaml"
    document.write_text(document.read_text().replace("../../LICENSE", "robot.yaml"))
    first = robot_model(str(folder), gripper=None)
    assert robot_model(str(folder), gripper=None) is first
    document.write_text(document.read_text().replace("title: ABB IRB 4600-60/2.05", "title: Mine"))
    assert robot_model(str(folder), gripper=None).title == "Mine"

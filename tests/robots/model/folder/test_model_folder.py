"""Model folders that are wrong are refused at the place in the document that is wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import CellError, DocumentError
from robots.model.registry import robot_model

BODY = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'

URDF = f"""<robot name="two">
  <link name="base">{BODY}</link>
  <link name="arm">{BODY}</link>
  <joint name="turn" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/></joint>
</robot>"""

MORE = """<link name="x"/><joint name="more" type="revolute"><parent link="arm"/><child link="x"/>
<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""

ROBOT = """flexcell: 1
robot: two
title: One joint
urdf: {file: two.urdf}
flange: arm
joints:
  - {name: turn, lower_rad: -1.0, upper_rad: 1.0, velocity_rad_s: 1.0, acceleration_rad_s2: 1.0,
     jerk_rad_s3: 1.0, effort_nm: 1.0, home_rad: 0.0}
licence: {name: CC0-1.0, file: two.urdf}
"""

TOOL = """flexcell: 1
tool: nail
title: A nail
urdf: {file: nail.urdf}
tcp: {xyz: [0, 0, 0.1]}
mechanism:
  kind: magnet
  face: {link: nail, size_m: [0.01, 0.01, 0.01]}
  max_force_n: 1.0
  reach_m: 0.001
  max_payload_kg: 0.1
licence: {name: CC0-1.0, file: nail.urdf}
"""

NAIL = URDF.replace('"base"', '"nail"').split('  <link name="arm">')[0] + "</robot>"


def written(folder: Path, *, robot: str = ROBOT, urdf: str = URDF) -> str:
    """Write an arm's folder and return its path."""
    folder.mkdir(exist_ok=True)
    (folder / "robot.yaml").write_text(robot)
    (folder / "two.urdf").write_text(urdf)
    return str(folder)


def tool(folder: Path, *, text: str = TOOL, urdf: str = NAIL) -> str:
    """Write a tool's folder and return its path."""
    folder.mkdir(exist_ok=True)
    (folder / "tool.yaml").write_text(text)
    (folder / "nail.urdf").write_text(urdf)
    return str(folder)


def test_a_sound_folder_is_a_robot_with_limits_where_the_urdf_has_none(tmp_path: Path) -> None:
    model = robot_model(written(tmp_path / "two"), gripper=None)
    assert (model.name, model.base_link, model.tool_link, model.dof) == ("two", "base", "arm", 1)
    assert 'type="revolute"' in model.urdf_text
    assert 'lower="-1.0"' in model.urdf_text


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("name: turn", "name: tern", r"robot\.yaml:7:12: the URDF has no joint tern \(did you mean turn"),
        ("flange: arm", "flange: hand", r"robot\.yaml:5:9: the URDF has no link hand"),
        ("title:", "tittle:", r"robot\.yaml:3:1: unknown key `tittle` \(did you mean title"),
        ("effort_nm: 1.0", "effort_nm: -1.0", r"robot\.yaml:8:\d+: `effort_nm`"),
        ("home_rad: 0.0", "home_rad: 2.0", r"robot\.yaml:8:\d+: home of turn is outside its limits"),
        ("urdf: {file: two.urdf}", "urdf: {file: two.urdf, root: bass}", "no link bass .did you mean base"),
        ("licence: {name: CC0-1.0, file: two.urdf}", "", "the key `licence` is missing"),
    ],
)
def test_what_does_not_fit_is_said_with_its_place(tmp_path: Path, old: str, new: str, words: str) -> None:
    folder = written(tmp_path / "two", robot=ROBOT.replace(old, new))
    with pytest.raises(DocumentError, match=words):
        robot_model(folder, gripper=None)


@pytest.mark.parametrize(
    ("urdf", "words"),
    [
        ("<robot", "the URDF cannot be read"),
        (URDF.replace(BODY, '<visual><geometry><mesh filename="no.stl"/></geometry></visual>', 1), "no mesh"),
        (URDF.replace("</robot>", MORE), "the movable joint more of the URDF is missing"),
    ],
)
def test_a_urdf_that_does_not_do_is_refused(tmp_path: Path, urdf: str, words: str) -> None:
    folder = written(tmp_path / "two", urdf=urdf)
    with pytest.raises(CellError, match=words):
        robot_model(folder, gripper=None)


def test_a_tool_gets_its_name_before_the_names_of_its_links(tmp_path: Path) -> None:
    model = robot_model(written(tmp_path / "two"), gripper=tool(tmp_path / "nail"))
    assert model.tool is not None
    assert (model.tool.links, model.tool_link) == (("nail_nail", "nail_tcp"), "nail_tcp")


def test_names_that_arm_and_tool_both_have_are_refused(tmp_path: Path) -> None:
    held = tool(
        tmp_path / "nail",
        text=TOOL.replace("link: nail", "link: arm") + "prefix: ''\n",
        urdf=NAIL.replace('"nail"', '"arm"'),
    )
    with pytest.raises(CellError, match=r"arm and tool both have a link or joint arm \(give the tool a `prefix`\)"):
        robot_model(written(tmp_path / "two"), gripper=held)


def test_the_mass_that_the_links_of_a_tool_lack_is_added_to_its_root(tmp_path: Path) -> None:
    model = robot_model(written(tmp_path / "two"), gripper=tool(tmp_path / "nail", text=TOOL + "mass_kg: 2.5\n"))
    assert model.tool is not None
    assert model.tool.mass_kg == pytest.approx(2.5)
    with pytest.raises(CellError, match="cannot be scaled to"):
        robot_model(
            written(tmp_path / "two"),
            gripper=tool(
                tmp_path / "other",
                text=TOOL + "mass_kg: 2.5\n",
                urdf=NAIL.replace(BODY, ""),
            ),
        )

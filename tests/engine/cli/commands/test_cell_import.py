"""`flexcell cell import`: meshes become fixtures, URDF files modules; what is left out is said."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.document.module_document import load_module
from tests.engine.cli.command import flexcell
from tests.robots.mesh_files import tray, write_mesh

CELL = """\
flexcell: 1
cell: press  # the one in hall 3
world: {kind: mujoco}

fixtures:
  floor: {shape: box, size_m: [3.0, 3.0, 0.04]}  # concrete
"""
RACK = """\
<robot name="rack">
  <material name="blue"><color rgba="0.2 0.4 0.8 1"/></material>
  <link name="base">
    <inertial><mass value="3"/></inertial>
    <visual><geometry><box size="0.4 0.3 0.02"/></geometry><material name="blue"/></visual>
    <collision><geometry><box size="0.4 0.3 0.02"/></geometry></collision>
  </link>
  <link name="Shelf-1">
    <visual>
      <origin xyz="0 0 0.01"/><geometry><mesh filename="package://tray.stl" scale="0.001 0.001 0.001"/></geometry>
    </visual>
  </link>
  <link name="slot"/>
  <link name="knob"><collision><geometry><sphere radius="0.02"/></geometry></collision></link>
  <joint name="to_shelf" type="fixed">
    <parent link="base"/><child link="Shelf-1"/><origin xyz="0.1 0 0.2" rpy="0 0 1.5707963267948966"/>
  </joint>
  <joint name="to_slot" type="fixed"><parent link="Shelf-1"/><child link="slot"/><origin xyz="0.1 0 0"/></joint>
  <joint name="to_knob" type="fixed"><parent link="base"/><child link="knob"/></joint>
</robot>
"""


@pytest.fixture(name="folder")
def _folder(tmp_path: Path) -> Path:
    (tmp_path / "cells").mkdir()
    (tmp_path / "cells" / "press.yaml").write_text(CELL, encoding="utf-8")
    (tmp_path / "rack.urdf").write_text(RACK, encoding="utf-8")
    write_mesh(tray(), tmp_path / "tray.stl", scale=1000.0)
    return tmp_path


def test_a_mesh_is_copied_beside_the_cell_and_added_to_it(folder: Path) -> None:
    said = flexcell("cell", "import", "tray.stl", "--scale", "0.001", "--cell", "cells/press.yaml", cwd=folder)
    assert (said.code, said.err) == (0, "")
    assert said.out == "fixture tray: cells/meshes/tray.stl, cells/press.yaml\n"
    text = (folder / "cells" / "press.yaml").read_text(encoding="utf-8")
    assert text == f"{CELL}  tray: {{shape: mesh, file: meshes/tray.stl, scale: 0.001, at: {{xyz: [0.0, 0.0, 0.0]}}}}\n"
    assert (folder / "cells" / "meshes" / "tray.stl").read_bytes() == (folder / "tray.stl").read_bytes()
    assert flexcell("check", "cells/press.yaml", cwd=folder).code == 0


def test_a_mesh_in_another_unit_is_imported_with_a_warning(folder: Path) -> None:
    said = flexcell("cell", "import", "tray.stl", "--cell", "cells/press.yaml", "--name", "bin", cwd=folder)
    assert said.code == 0
    assert "the mesh is 300 x 200 x 80 m large" in said.err
    assert "`scale: 0.001` for millimetres" in said.err
    assert load_cell(folder / "cells" / "press.yaml").document.fixtures["bin"].file == "meshes/bin.stl"


def test_a_urdf_of_fixed_links_is_a_module_and_what_is_left_out_has_its_line(folder: Path) -> None:
    said = flexcell("cell", "import", "rack.urdf", "--cell", "cells/press.yaml", cwd=folder)
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines() == [
        "module rack: cells/modules/rack/module.yaml, cells/modules/rack/meshes/tray.stl",
        "left out: rack.urdf:3: link `base`: its collision shapes: bodies touch what is seen",
        "left out: rack.urdf:3: link `base`: its mass: fixtures do not move",
        "left out: rack.urdf:14: link `knob`: a sphere: fixtures are boxes, cylinders and meshes",
        "dock it: `modules: {rack: {module: modules/rack, connector: NAME}}`",
    ]
    assert (folder / "cells" / "press.yaml").read_text(encoding="utf-8") == CELL
    document = load_module(folder / "cells" / "modules" / "rack").document
    assert (list(document.fixtures), list(document.frames)) == (["base", "shelf_1"], ["slot", "knob"])
    base, shelf, slot = document.fixtures["base"], document.fixtures["shelf_1"], document.frames["slot"]
    assert (base.size_m, base.color) == ((0.4, 0.3, 0.02), "#3366cc")
    assert (shelf.file, shelf.scale) == ("meshes/tray.stl", 0.001)
    assert shelf.at.xyz == pytest.approx((0.1, 0.0, 0.21))
    assert slot.at.xyz == pytest.approx((0.1, 0.1, 0.2))
    assert slot.at.rpy == pytest.approx((0.0, 0.0, 1.5707963))
    assert flexcell("check", "cells/modules/rack/module.yaml", cwd=folder).code == 0


def test_a_urdf_with_a_joint_that_moves_is_a_robot(folder: Path) -> None:
    moving = RACK.replace('"to_knob" type="fixed"', '"to_knob" type="revolute"')
    (folder / "arm.urdf").write_text(moving, encoding="utf-8")
    said = flexcell("cell", "import", "arm.urdf", "--cell", "cells/press.yaml", cwd=folder)
    assert said.code == 2
    assert "arm.urdf:19:1: the joint `to_knob` is revolute" in said.err
    assert "docs/how-to/add-a-robot.md" in said.err
    assert not (folder / "cells" / "modules").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["no.stl"], "there is no such file"),
        (["cells/press.yaml"], "this is no mesh and no URDF"),
        (["tray.stl", "--name", "floor"], "`floor` is already a name in `fixtures`"),
        (["broken.stl"], "it is not an STL file"),
        (["tray.stl", "rack.urdf", "--name", "one"], "--name is for one file"),
        (["tray.stl", "--name", "taken"], "a file of this name is there already"),
    ],
)
def test_what_cannot_be_imported_changes_nothing(folder: Path, arguments: list[str], message: str) -> None:
    (folder / "broken.stl").write_bytes(b"no mesh")
    write_mesh(tray(), folder / "cells" / "meshes" / "taken.stl")
    said = flexcell("cell", "import", *arguments, "--cell", "cells/press.yaml", cwd=folder)
    assert said.code == 2
    assert message in said.err
    assert (folder / "cells" / "press.yaml").read_text(encoding="utf-8") == CELL

"""A written scene is read by the programs it is for, and is there what it is here."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace
from typer.testing import CliRunner

from engine.cli.main import app
from engine.document.cell import Cell, load_cell
from engine.errors import CellError
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.scene_builder import build_scene
from robots.scene_export.write_scene import write_scene
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.physics import mujoco

CELLS = Path(__file__).parents[3] / "behaviors" / "cells"
_Z_TO_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
pinocchio: Any = import_module("pinocchio")
trimesh: Any = import_module("trimesh")


def _cell(name: str) -> Cell:
    return load_cell(CELLS / f"{name}.yaml")


def _home(model: Any, arms: Any) -> Any:
    data = mujoco.MjData(model)
    for arm in arms:
        data.qpos[arm.qpos] = arm.model.home_rad
        if arm.tool is not None:
            data.qpos[arm.tool.qpos] = arm.tool.home
    return data


@pytest.mark.parametrize("name", ["dual_panda", "ur10", "servo_arm"])
def test_the_mjcf_falls_and_touches_as_the_simulation(tmp_path: Path, name: str) -> None:
    cell = _cell(name)
    (file,) = write_scene(cell, tmp_path / "cell.xml")
    read = mujoco.MjModel.from_xml_path(str(file))
    there = mujoco.MjData(read)
    mujoco.mj_resetDataKeyframe(read, there, read.key("home").id)
    own = build_cell(replace(build_scene(cell.document, resolve=cell.resolve), realism="ideal"))
    here = _home(own.model, own.arms)
    assert [read.body(i).name for i in range(read.nbody)] == list(own.body_names)
    assert np.allclose(there.qpos, here.qpos, atol=1e-12)
    assert read.body_mass == pytest.approx(own.model.body_mass, rel=1e-5, abs=1e-8)
    for _ in range(300):
        mujoco.mj_step(read, there)
        mujoco.mj_step(own.model, here)
    # Numbers in XML have fewer digits; 0.3 s of falling arms and of parts that are put down makes little of it.
    assert np.abs(there.qpos - here.qpos).max() < 1e-3
    assert np.abs(here.qpos - _home(own.model, own.arms).qpos).max() > 0.1


@pytest.mark.parametrize("name", ["dual_panda", "irb4600"])
def test_the_urdf_has_the_kinematics_masses_and_meshes_of_the_cell(tmp_path: Path, name: str) -> None:
    cell = _cell(name)
    file, *meshes = write_scene(cell, tmp_path / "there" / "cell.urdf")
    read: Any = pinocchio.buildModelFromUrdf(str(file))
    looks: Any = pinocchio.buildGeomFromUrdf(
        read, str(file), pinocchio.GeometryType.VISUAL, package_dirs=[str(file.parent)]
    )
    used = {Path(each.meshPath).name for each in looks.geometryObjects if Path(each.meshPath).suffix}
    assert {mesh.name for mesh in meshes if mesh.parent.name == "cell_meshes"} >= used
    data, rng = read.createData(), np.random.default_rng(3)
    for arm in build_scene(cell.document, resolve=cell.resolve).arms:
        model = arm.robot()
        joints: Array = rng.uniform(model.limits.lower_rad, model.limits.upper_rad)
        q = pinocchio.neutral(read)
        for joint, value in zip(model.arm_joints, joints, strict=True):
            q[read.joints[read.getJointId(f"{arm.name}/{joint}")].idx_q] = value
        pinocchio.framesForwardKinematics(read, data, q)
        found = data.oMf[read.getFrameId(f"{arm.name}/{model.tool_link}")]
        expected = ArmKinematics(model, base=RigidTransform.from_pose(arm.base)).tool_pose(joints)
        assert found.translation == pytest.approx(expected.xyz, abs=1e-9)
        assert found.rotation == pytest.approx(expected.rotation, abs=1e-9)
    for part, spec in cell.document.parts.items():
        pinocchio.framesForwardKinematics(read, data, pinocchio.neutral(read))
        placed = data.oMf[read.getFrameId(part)]
        assert placed.translation == pytest.approx(spec.at.pose().xyz, abs=1e-9)


def test_the_gltf_has_every_body_by_name_where_it_is_with_the_arms_at_home(tmp_path: Path) -> None:
    cell = _cell("dual_panda")
    (file,) = write_scene(cell, tmp_path / "cell.glb")
    read = trimesh.load_scene(file)
    own = build_cell(replace(build_scene(cell.document, resolve=cell.resolve), realism="ideal"))
    data = _home(own.model, own.arms)
    mujoco.mj_kinematics(own.model, data)
    for frame, body in zip(own.frames, own.frame_bodies, strict=True):
        matrix, _ = read.graph.get(frame)
        assert matrix[:3, 3] == pytest.approx(_Z_TO_Y_UP @ data.xpos[body], abs=1e-6), frame
        assert matrix[:3, :3] == pytest.approx(_Z_TO_Y_UP @ data.xmat[body].reshape(3, 3), abs=1e-6), frame
    low, high = read.bounds
    assert (low[1] > -0.1, 0.6 < high[1] < 1.0) == (True, True)


def test_frames_are_there_and_modules_that_are_not_plugged_are_not(tmp_path: Path) -> None:
    cell = _cell("trolley")
    assert not cell.document.modules["trolley"].plugged
    (file,) = write_scene(cell, tmp_path / "cell.glb")
    nodes = set(trimesh.load_scene(file).graph.nodes)
    assert {name for name in nodes if str(name).partition("/")[0] == "trolley"} == set()
    assert nodes >= {"rack", "rack/plate", "rack/place_1", "north", "south", "floor"}
    urdf, *_ = write_scene(cell, tmp_path / "cell.urdf")
    assert "trolley/block_1" not in urdf.read_text()
    assert "rack/" in urdf.read_text()


def test_an_unknown_format_and_a_folder_that_cannot_be_written_are_refused(tmp_path: Path) -> None:
    with pytest.raises(CellError, match=r"cell\.stl is no scene") as unknown:
        write_scene(_cell("servo_arm"), tmp_path / "cell.stl")
    assert ".xml, .urdf, .glb" in (unknown.value.hint or "")
    (tmp_path / "file").write_text("")
    with pytest.raises(CellError, match="cannot be written"):
        write_scene(_cell("servo_arm"), tmp_path / "file" / "cell.xml")


def test_the_command_prints_what_it_wrote(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    done = CliRunner().invoke(app, ["cell", "export", str(CELLS / "dual_panda.yaml"), "-o", str(file)])
    assert done.exit_code == 0, done.output
    printed = done.output.split()
    assert printed[0] == str(file)
    assert sorted(printed) == sorted(str(path) for path in tmp_path.rglob("*") if path.is_file())

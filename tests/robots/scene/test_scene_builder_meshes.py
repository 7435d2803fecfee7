"""A fixture that is a mesh: one set of convex pieces in physics and planning; its surface is drawn and written."""

from __future__ import annotations

from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.document import load_cell
from engine.errors import CellError
from engine.messages import Pose
from robots.model.inverse_kinematics import InverseKinematicsSolver
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.planning.request import JointGoal, PathPlan, PlanRequest
from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.worker.scene_planner import ScenePlanner
from robots.port import Array
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import SimScene
from robots.scene_export.write_scene import write_scene
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.physics import mujoco
from robots.sim.physics.scene_description import describe_scene
from tests.robots.mesh_files import DEPTH_M, WALL_M, tray, write_mesh

trimesh: Any = import_module("trimesh")
pinocchio: Any = import_module("pinocchio")

DOWN_TURNED = (0.5**0.5, 0.5**0.5, 0.0, 0.0)
"""The wide hand is along the long side of the tray."""
ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  arm: {model: panda, gripper: {model: panda_hand}}
fixtures:
  table: {shape: box, size_m: [0.5, 0.6, 0.1], at: {xyz: [0.55, 0, 0.05]}}
  tray: {shape: mesh, file: meshes/tray.stl, scale: 0.001, at: {frame: table, xyz: [0, 0, 0.05]}, color: "#3070b0"}
parts:
  block:
    {shape: box, size_m: [0.04, 0.04, 0.04], mass_kg: 0.1, at: {frame: tray, xyz: [0.1, 0.06, 0.15], rpy: [0.3, 0, 0]}}
"""


def cell_file(folder: Path, text: str = CELL) -> Path:
    write_mesh(tray(), folder / "meshes" / "tray.stl", scale=1000.0)
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    return folder / "cell.yaml"


def scene_of(file: Path) -> SimScene:
    cell = load_cell(file)
    return build_scene(cell.document, resolve=cell.resolve)


def test_a_part_that_falls_into_a_tray_lies_in_it(tmp_path: Path) -> None:
    cell = build_cell(scene_of(cell_file(tmp_path)))
    data = mujoco.MjData(cell.model)
    for _ in range(1500):
        mujoco.mj_step(cell.model, data)
    x, y, z = data.body("block").xpos.tolist()
    # The floor of the tray is above the table, the block lies on it, and the walls are around it.
    assert z == pytest.approx(0.1 + WALL_M + 0.02, abs=2e-3)
    assert abs(x - 0.55) < 0.15 - WALL_M
    assert abs(y) < 0.1 - WALL_M
    assert np.abs(data.qvel).max() < 5.0


def test_a_wall_of_the_mesh_holds_a_part_that_is_pushed(tmp_path: Path) -> None:
    cell = build_cell(scene_of(cell_file(tmp_path)))
    data = mujoco.MjData(cell.model)
    for step in range(2500):
        data.body("block").xfrc_applied[0] = 2.0 if step > 1000 else 0.0
        mujoco.mj_step(cell.model, data)
    assert data.body("block").xpos[0] == pytest.approx(0.55 + 0.15 - WALL_M - 0.02, abs=3e-3)


def touches_of_tray(scene: SimScene, path: Array) -> int:
    """Return at how many of the configurations the arm touches the tray in physics."""
    cell = build_cell(scene)
    data, tray_body = mujoco.MjData(cell.model), cell.model.body("tray").id
    touching = 0
    for joints in path:
        data.qpos[cell.arms[0].qpos] = joints
        mujoco.mj_forward(cell.model, data)
        bodies = [cell.model.geom_bodyid[contact.geom] for contact in data.contact[: data.ncon] if contact.dist < 0.0]
        touching += any(tray_body in pair for pair in bodies)
    return touching


def test_the_planner_goes_over_the_wall_into_the_hollow_of_a_mesh(tmp_path: Path) -> None:
    sim = scene_of(cell_file(tmp_path, CELL.partition("parts:")[0]))
    scene = planning_scene(sim)
    solver = InverseKinematicsSolver(ArmKinematics(scene.arms[0].placement.robot(), base=ORIGIN))
    checker = ExactChecker(scene, "arm")

    def all_joints(xyz: tuple[float, float, float]) -> list[Array]:
        return list(solver.all_solutions(RigidTransform.of(xyz, DOWN_TURNED)).joints)

    def free_joints(xyz: tuple[float, float, float]) -> tuple[float, ...]:
        return next(tuple(joints.tolist()) for joints in all_joints(xyz) if not checker.in_collision(joints))

    beside, inside = free_joints((0.55, -0.2, 0.14)), free_joints((0.55, 0.0, 0.14))
    for joints in all_joints((0.55, -0.1 + WALL_M / 2, 0.1 + DEPTH_M - 0.02)):
        assert "tray" in {name for pair in checker.colliding_pairs(joints) for name in pair}
    request = PlanRequest(scene=scene, arm="arm", start_rad=beside, goal=JointGoal(joints_rad=(inside,)))
    answer = ScenePlanner(check_s=2e-5).plan(request)
    assert isinstance(answer, PathPlan), answer
    straight = np.linspace(beside, inside, 50)
    assert any(checker.in_collision(joints) for joints in straight)
    assert touches_of_tray(sim, straight) > 0
    legs: list[Array] = [np.linspace(a, b, 20) for a, b in pairwise(answer.path)]
    assert touches_of_tray(sim, np.vstack(legs)) == 0


def test_what_is_drawn_is_the_surface_of_the_file_in_the_colour_of_the_fixture(tmp_path: Path) -> None:
    scene = scene_of(cell_file(tmp_path))
    (drawn,) = (each for each in describe_scene(scene).geometries if each.name.startswith("tray"))
    assert (drawn.name, drawn.kind, drawn.frame, drawn.xyz) == ("tray/0", "mesh", "world", (0.55, 0.0, 0.1))
    assert drawn.rgba == pytest.approx((0x30 / 255, 0x70 / 255, 0xB0 / 255, 1.0))
    points = np.frombuffer(drawn.vertices, np.float32).reshape(-1, 3)
    assert np.ptp(points, axis=0) == pytest.approx([0.3, 0.2, DEPTH_M], abs=1e-6)
    # Each of its 16 corners is drawn in three surfaces, with an edge between them.
    assert (len(points), len(np.unique(points, axis=0))) == (48, 16)


def test_exports_have_the_surface_and_what_touches_has_the_pieces(tmp_path: Path) -> None:
    cell = load_cell(cell_file(tmp_path))
    pieces = scene_of(cell.file).fixtures[1].mesh
    assert pieces is not None
    (glb,) = write_scene(cell, tmp_path / "out" / "cell.glb")
    low, high = trimesh.load_scene(str(glb)).bounds
    (xml,) = write_scene(cell, tmp_path / "out" / "cell.xml")
    model = mujoco.MjModel.from_xml_path(str(xml))
    geoms = [model.geom(i) for i in range(model.ngeom) if model.geom(i).bodyid[0] == model.body("tray").id]
    assert [int(geom.group[0]) for geom in geoms].count(2) == 1
    assert [int(geom.group[0]) for geom in geoms].count(3) == len(pieces.pieces)
    urdf, *_ = write_scene(cell, tmp_path / "out" / "cell.urdf")
    read = pinocchio.buildModelFromUrdf(str(urdf))
    kinds = (pinocchio.GeometryType.VISUAL, pinocchio.GeometryType.COLLISION)
    models = [pinocchio.buildGeomFromUrdf(read, str(urdf), kind, package_dirs=[str(urdf.parent)]) for kind in kinds]
    counts = [sum(each.name.startswith("tray") for each in one.geometryObjects) for one in models]
    assert counts == [1, len(pieces.pieces)]
    assert (low < high).all()


def test_another_mesh_is_another_cell(tmp_path: Path) -> None:
    file = cell_file(tmp_path)
    before = load_cell(file)
    assert load_cell(file).content == before.content
    write_mesh(trimesh.creation.box((0.3, 0.2, 0.1)), tmp_path / "meshes" / "tray.stl", scale=1000.0)
    assert load_cell(file).content != before.content


def test_a_mesh_of_a_module_is_beside_its_document(tmp_path: Path) -> None:
    write_mesh(tray(), tmp_path / "modules" / "bin" / "tray.stl")
    module = "flexcell: 1\nmodule: bin\nfixtures:\n  tray: {shape: mesh, file: tray.stl}\n"
    (tmp_path / "modules" / "bin" / "module.yaml").write_text(module, encoding="utf-8")
    text = (
        "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\nconnectors:\n  dock: {at: {xyz: [0.5, 0, 0.2]}}\n"
        "modules:\n  full: {module: modules/bin, connector: dock}\n"
    )
    (tmp_path / "cell.yaml").write_text(text, encoding="utf-8")
    (fixture,) = scene_of(tmp_path / "cell.yaml").fixtures
    assert (fixture.name, fixture.pose) == ("full/tray", Pose(xyz=(0.5, 0.0, 0.2)))
    assert fixture.mesh is not None
    assert set(load_cell(tmp_path / "cell.yaml").meshes) == {"modules/bin/tray.stl"}


def test_a_mesh_that_is_missing_names_the_fixture(tmp_path: Path) -> None:
    file = cell_file(tmp_path)
    (tmp_path / "meshes" / "tray.stl").unlink()
    with pytest.raises(CellError, match="fixture `tray`: the mesh cannot be read"):
        scene_of(file)

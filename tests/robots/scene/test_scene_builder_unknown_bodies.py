"""Unknown bodies: in the physics, in images and in the drawing, and nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.cell_names import cell_names
from engine.document.cell import Cell, load_cell
from robots.planning.scene.cell_planning_scene import known_obstacles, planning_scene
from robots.scene.scene_builder import build_scene
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.scene_description import describe_scene
from robots.vision.camera_rig import CameraRig
from tests.robots.vision.watched_cell import cameras, look, perception_setup, voxels

_TEXT = """
flexcell: 1
cell: crates
world: {kind: mujoco}
robots:
  arm: {model: servo_arm}
fixtures:
  floor: {shape: box, size_m: [2, 2, 0.04], at: {xyz: [0, 0, -0.02]}}
parts:
  can: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.2, at: {xyz: [0.4, 0.3, 0.05]}}
cameras:
  front: {at: [2.0, 0.0, 1.6], look_at: [0.4, 0.0, 0.3]}
occupancy: {center_m: [0.5, 0, 0.5], size_m: [1.0, 1.2, 1.0]}
unknown_bodies:
  crate: {shape: box, size_m: [0.2, 0.2, 0.2], at: {xyz: [0.5, 0, 0.3]}}
  ball: {shape: sphere, size_m: [0.1], mass_kg: 0.3, at: {xyz: [0.5, -0.4, 0.5]}}
"""


@pytest.fixture(name="cell")
def _cell(tmp_path: Path) -> Cell:
    file = tmp_path / "crates.yaml"
    file.write_text(_TEXT, encoding="utf-8")
    return load_cell(file)


def test_physics_contains_them_and_only_those_with_a_mass_fall(cell: Cell) -> None:
    built = build_cell(build_scene(cell.document))
    simulation = Simulation(built)
    start = dict(zip(built.frames, _heights(simulation), strict=True))
    for _ in range(200):
        simulation.step()
    after = dict(zip(built.frames, _heights(simulation), strict=True))
    assert {"crate", "ball"} <= set(built.body_names)
    assert after["ball"] < start["ball"] - 0.1
    assert "crate" not in built.frames


def test_known_parts_names_and_planning_scene_lack_them(cell: Cell) -> None:
    scene = build_scene(cell.document)
    names = cell_names(cell)
    assert build_cell(scene).parts == ("can",)
    assert {obstacle.name for obstacle in known_obstacles(scene)} == {"floor", "can"}
    assert {obstacle.name for obstacle in planning_scene(scene).obstacles} == {"floor", "can"}
    assert not {"crate", "ball"} & frozenset[str]().union(*names.by_kind.values())


def test_the_drawing_and_the_cameras_show_them(cell: Cell) -> None:
    scene = build_scene(cell.document)
    assert {"crate", "ball"} <= {geometry.name for geometry in describe_scene(scene).geometries}
    rig = CameraRig(perception_setup(scene, *cameras(front=cell.document.cameras["front"])), repeatable=True)
    occupied = voxels(rig.look(look(scene)).grid)
    assert ((abs(occupied - (0.5, 0.0, 0.3)) < 0.12).all(axis=1)).sum() > 20
    assert ((abs(occupied - (0.5, -0.4, 0.5)) < 0.07).all(axis=1)).sum() > 3


def _heights(simulation: Simulation) -> list[float]:
    values = simulation.layout.new_array()
    simulation.write_snapshot(values)
    return [xyz[2] for xyz in SimSnapshot(simulation.layout, values).frames()[0]]

"""A cell of two arms with two bins, which are modules: neither is plugged when the cell is opened."""

from __future__ import annotations

from pathlib import Path

from engine.document.cell import Cell, load_cell
from robots.scene.docked_scene import with_modules
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import SimScene

MODULE = """\
flexcell: 1
module: bin
frames:
  slot_1: {parent: tray, at: {xyz: [-0.06, 0, 0.005]}}
  slot_2: {parent: tray, at: {xyz: [0.06, 0, 0.005]}}
fixtures:
  tray: {shape: tray, size_m: [0.3, 0.16, 0.03]}
parts:
  block: {shape: box, size_m: [0.06, 0.03, 0.04], mass_kg: 0.1, at: {frame: slot_1, xyz: [0, 0, 0.02]}}
  ball: {shape: sphere, size_m: [0.04], mass_kg: 0.05, at: {frame: slot_2, xyz: [0, 0, 0.02]}}
"""
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda, base: {xyz: [0, 0.4, 0]}, gripper: {model: panda_hand}}
  right: {model: panda, base: {xyz: [0, -0.4, 0]}, gripper: {model: panda_hand}}
fixtures:
  table: {shape: box, size_m: [0.6, 1.4, 0.2], at: {xyz: [0.7, 0, 0.1]}}
parts:
  own: {shape: box, size_m: [0.05, 0.05, 0.05], mass_kg: 0.1, at: {xyz: [0.5, 0, 0.225]}}
connectors:
  dock_1: {parent: table, at: {xyz: [-0.1, 0.4, 0.1]}}
  dock_2: {parent: table, at: {xyz: [-0.1, -0.4, 0.1], rpy: [0, 0, 1.5707963267948966]}}
modules:
  full: {module: bin, connector: dock_1, plugged: false}
  other: {module: bin, plugged: false}
"""


def module_cell(folder: Path, *, cell: str = CELL, module: str = MODULE) -> Cell:
    """Write the cell and its module, and return it."""
    (folder / "bin").mkdir(exist_ok=True)
    (folder / "bin" / "module.yaml").write_text(module, encoding="utf-8")
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def module_scene(cell: Cell) -> SimScene:
    """Return all that may be in its world."""
    return with_modules(build_scene(cell.document, resolve=cell.resolve), cell)

"""Findings of meshes stand at the line of their fixture, also of one on a module."""

from __future__ import annotations

from pathlib import Path

from engine.check import check_cell, check_module
from engine.document.cell import load_cell
from engine.document.module_document import load_module
from tests.robots.mesh_files import tray, write_mesh

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  good: {shape: mesh, file: tray_mm.stl, scale: 0.001}
  large: {shape: mesh, file: tray_mm.stl}
  gone: {shape: mesh, file: gone.stl}
connectors:
  dock: {parent: world}
modules:
  full: {module: bin, connector: dock}
"""
MODULE = """\
flexcell: 1
module: bin
fixtures:
  tray: {shape: mesh, file: tray_m.stl, scale: 0.001}
"""


def test_a_missing_and_an_implausible_mesh_are_found_in_cell_and_module(tmp_path: Path) -> None:
    write_mesh(tray(), tmp_path / "tray_mm.stl", scale=1000.0)
    write_mesh(tray(), tmp_path / "bin" / "tray_m.stl")
    (tmp_path / "bin" / "module.yaml").write_text(MODULE, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    found = [str(each).replace(f"{tmp_path}/", "") for each in check_cell(load_cell(tmp_path / "cell.yaml"))]
    of_module = "bin/module.yaml:4:48: warning: `{}tray_m.stl`: the mesh is 0.0003 x 0.0002 x 8e-05 m large"
    assert [line.partition(" (")[0] for line in found] == [
        of_module.format("bin/"),
        "cell.yaml:6:30: warning: `tray_mm.stl`: the mesh is 300 x 200 x 80 m large",
        "cell.yaml:7:29: error: `gone.stl`: there is no such file",
    ]
    (alone,) = check_module(load_module(tmp_path / "bin"))
    assert str(alone).replace(f"{tmp_path}/", "").startswith(of_module.format(""))

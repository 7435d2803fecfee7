"""What is wrong with a mesh file is told with what to do, before a cell is opened with it."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from engine.errors import CellError
from robots.model.meshes.mesh_solids import inspect_mesh, read_solids
from tests.robots.mesh_files import tray, write_mesh

trimesh: Any = import_module("trimesh")


@pytest.mark.parametrize("name", ["tray.stl", "tray.obj", "tray.dae"])
def test_a_closed_mesh_of_a_plausible_size_has_no_defects_in_any_format(tmp_path: Path, name: str) -> None:
    file = write_mesh(tray(), tmp_path / name)
    assert inspect_mesh(file, scale=1.0) == ()
    assert read_solids(file, scale=1.0).size_m.tolist() == pytest.approx([0.3, 0.2, 0.08], abs=1e-6)


def test_a_file_in_millimetres_is_reported_with_the_scale_that_fits(tmp_path: Path) -> None:
    file = write_mesh(tray(), tmp_path / "tray.stl", scale=1000.0)
    (defect,) = inspect_mesh(file, scale=1.0)
    assert (defect.key, defect.unusable) == ("file", False)
    assert defect.message == "the mesh is 300 x 200 x 80 m large"
    assert "`scale: 0.001` for millimetres" in defect.hint
    assert inspect_mesh(file, scale=0.001) == ()


def test_a_scale_that_makes_a_mesh_too_small_is_where_the_finding_is(tmp_path: Path) -> None:
    (defect,) = inspect_mesh(write_mesh(tray(), tmp_path / "tray.stl"), scale=0.001)
    assert (defect.key, defect.hint) == ("scale", "its numbers fit `scale: 1` for metres")


def test_an_open_surface_is_reported_with_the_number_of_its_open_edges(tmp_path: Path) -> None:
    box = trimesh.creation.box((0.3, 0.2, 0.04))
    box.update_faces(box.face_normals[:, 2] < 0.5)
    (defect,) = inspect_mesh(write_mesh(box, tmp_path / "open.stl"), scale=1.0)
    assert (defect.message.partition(":")[0], defect.unusable) == ("the mesh is open at 4 edges", False)


def test_what_has_no_volume_is_unusable(tmp_path: Path) -> None:
    sheet = trimesh.Trimesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    (defect,) = inspect_mesh(write_mesh(sheet, tmp_path / "sheet.stl"), scale=1.0)
    assert defect.unusable
    assert defect.message.startswith("the mesh has no volume")


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.stl", b"not a mesh", "it is not an STL file"),
        ("a.step", b"ISO-10303-21;", "its file type is not one of"),
        ("a.dae", b"<COLLADA/>", "the mesh cannot be read"),
        ("a.obj", b"v 0 0 0\n", "the mesh"),
    ],
)
def test_a_file_that_is_no_mesh_is_refused(tmp_path: Path, name: str, content: bytes, message: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(CellError, match=message):
        read_solids(tmp_path / name, scale=1.0)


def test_separate_bodies_are_separate_solids(tmp_path: Path) -> None:
    two = trimesh.util.concatenate(
        [trimesh.creation.box((0.1, 0.1, 0.1)), trimesh.creation.icosphere(radius=0.05).apply_translation((1, 0, 0))]
    )
    solids = read_solids(write_mesh(two, tmp_path / "two.stl"), scale=1.0).solids
    assert sorted(round(float(solid.volume), 5) for solid in solids) == pytest.approx([0.00051, 0.001], abs=2e-5)

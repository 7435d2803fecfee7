"""A mesh becomes convex pieces that keep its hollows, the same ones each time, and comes from the cache later."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.document import Decomposition
from engine.errors import CellError
from robots.model.meshes import convex_pieces as module
from robots.model.meshes.convex_pieces import Piece, convex_pieces
from tests.robots.mesh_files import DEPTH_M, OUTER_M, WALL_M, tray, write_mesh

trimesh: Any = import_module("trimesh")
spatial: Any = import_module("scipy.spatial")


def is_inside(piece: Piece, point: tuple[float, float, float]) -> bool:
    equations = np.array(spatial.ConvexHull(np.array(piece)).equations)
    return bool((equations[:, :3] @ np.array(point) + equations[:, 3]).max() < 0.0)


def volume_m3(pieces: tuple[Piece, ...]) -> float:
    return sum(float(spatial.ConvexHull(np.array(piece)).volume) for piece in pieces)


def test_a_tray_stays_hollow_and_has_its_floor_and_walls(tmp_path: Path) -> None:
    file = write_mesh(tray(), tmp_path / "tray.stl", scale=1000.0)
    pieces = convex_pieces(file, scale=0.001, cache=tmp_path / "cache")
    assert 5 <= len(pieces) <= 64
    half = OUTER_M[0] / 2
    heights = (WALL_M + 0.004, DEPTH_M - 0.001)
    hollow = [(x, y, z) for x in (-0.12, 0.0, 0.12) for y in (-0.08, 0.0, 0.08) for z in heights]
    assert [point for point in hollow if any(is_inside(piece, point) for piece in pieces)] == []
    solid = [(0.02, 0.01, WALL_M / 2), (half - WALL_M / 2, 0.01, DEPTH_M / 2), (0.01, 0.1 - WALL_M / 2, DEPTH_M / 2)]
    assert all(any(is_inside(piece, point) for piece in pieces) for point in solid)
    assert volume_m3(pieces) == pytest.approx(float(tray().volume), rel=0.08)


def test_the_same_content_gives_the_same_pieces_and_is_decomposed_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, again = write_mesh(tray(), tmp_path / "tray.stl"), write_mesh(tray(), tmp_path / "other" / "again.stl")
    first = convex_pieces(file, scale=1.0, cache=tmp_path / "one")
    assert convex_pieces(file, scale=1.0, cache=tmp_path / "two") == first

    def refuse(*_: object) -> tuple[Piece, ...]:
        raise AssertionError("it is decomposed again")

    monkeypatch.setattr(module, "_decomposed", refuse)
    assert convex_pieces(again, scale=1.0, cache=tmp_path / "one") == first
    with pytest.raises(AssertionError):
        convex_pieces(again, scale=1.01, cache=tmp_path / "one")
    with pytest.raises(AssertionError):
        convex_pieces(again, scale=1.0, decomposition=Decomposition(error_m=0.01), cache=tmp_path / "one")


def test_convex_solids_are_kept_as_they_are(tmp_path: Path) -> None:
    boxes = [trimesh.creation.box((0.1, 0.2, 0.3)).apply_translation((x, 0, 0)) for x in (0.0, 1.0, 2.0)]
    file = write_mesh(trimesh.util.concatenate(boxes), tmp_path / "three.obj")
    pieces = convex_pieces(file, scale=1.0, cache=tmp_path)
    assert [len(piece) for piece in pieces] == [8, 8, 8]
    assert volume_m3(pieces) == pytest.approx(0.018)
    with pytest.raises(CellError, match="3 separate solids, and `decomposition` allows 2 pieces"):
        convex_pieces(file, scale=1.0, decomposition=Decomposition(parts=2), cache=tmp_path)


def test_a_mesh_in_the_wrong_unit_is_decomposed_coarsely_and_soon(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """300 m instead of 300 mm, of which 5 mm would be searched for an hour."""
    asked = list[float]()
    coacd: Any = import_module("coacd")

    def search(*_: Any, threshold: float, **__: Any) -> list[tuple[Any, Any]]:
        asked.append(threshold)
        return []

    monkeypatch.setattr(coacd, "run_coacd", search)
    file = write_mesh(tray(), tmp_path / "tray.stl", scale=1000.0)
    for scale in (0.001, 1.0):
        convex_pieces(file, scale=scale, cache=tmp_path)
    assert asked == pytest.approx([0.005, 6.0])


def test_one_piece_is_the_hull(tmp_path: Path) -> None:
    file = write_mesh(tray(), tmp_path / "tray.stl")
    (piece,) = convex_pieces(file, scale=1.0, decomposition=Decomposition(parts=1), cache=tmp_path)
    assert volume_m3((piece,)) == pytest.approx(0.3 * 0.2 * DEPTH_M)


def test_a_missing_file_is_reported(tmp_path: Path) -> None:
    with pytest.raises(CellError, match="the mesh cannot be read"):
        convex_pieces(tmp_path / "no.stl", scale=1.0, cache=tmp_path)

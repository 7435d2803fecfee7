"""Mesh files of tests: a tray with thin walls, written in the units that a test wants."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

OUTER_M, DEPTH_M, WALL_M = (0.3, 0.2), 0.08, 0.006


def tray() -> Any:
    """Return a closed tray, in metres: 300 x 200 x 80 mm with walls and a floor of 6 mm, its origin below the floor."""
    trimesh: Any = import_module("trimesh")
    x, y = OUTER_M[0] / 2, OUTER_M[1] / 2
    outer = [(-x, -y), (x, -y), (x, y), (-x, y)]
    inner = [(a - WALL_M if a > 0 else a + WALL_M, b - WALL_M if b > 0 else b + WALL_M) for a, b in outer]
    heights = ((outer, 0.0), (outer, DEPTH_M), (inner, DEPTH_M), (inner, WALL_M))
    corners = [(a, b, z) for ring, z in heights for a, b in ring]
    squares = [(3, 2, 1, 0), (12, 13, 14, 15)]
    for k in range(4):
        n = (k + 1) % 4
        squares += [(4 * ring + k, 4 * ring + n, 4 * ring + 4 + n, 4 * ring + 4 + k) for ring in range(3)]
    faces = [face for a, b, c, d in squares for face in ((a, b, c), (a, c, d))]
    return trimesh.Trimesh(vertices=corners, faces=faces, process=False)


def write_mesh(mesh: Any, file: Path, *, scale: float = 1.0) -> Path:
    """Write a mesh in the format of the file's name, as so many units for one metre."""
    scaled = mesh.copy()
    scaled.apply_scale(scale)
    file.parent.mkdir(parents=True, exist_ok=True)
    scaled.export(str(file))
    return file

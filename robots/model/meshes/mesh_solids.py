"""Reads a mesh file as separate solids in metres, and tells what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from engine.cell import MeshDefect
from engine.errors import CellError
from robots.model.urdf.mesh_file import require_triangles, verify_mesh_file
from robots.port import Array

PLAUSIBLE_M = (0.002, 10.0)
"""The largest edge of a fixture is between these."""
_UNITS = {"millimetres": 0.001, "centimetres": 0.01, "inches": 0.0254, "metres": 1.0}
_EXTRA = "pip install 'flexcell[sim]'"


@dataclass(frozen=True, kw_only=True)
class MeshSolids:
    """The closed surfaces of a mesh, and the one of all triangles that are in none; trimesh's, in metres.

    `open_edges` counts the edges that belong to one triangle only.
    """

    solids: tuple[Any, ...]
    size_m: Array
    open_edges: int


def trimesh_module() -> Any:
    """Return trimesh, which is slow to import.

    Raises:
        CellError: it is not installed.
    """
    try:
        return import_module("trimesh")
    except ImportError as error:
        raise CellError(f"meshes need the package `{error.name}`, which is not installed", hint=_EXTRA) from error


def read_solids(file: Path, *, scale: float) -> MeshSolids:
    """Read a mesh file.

    Args:
        file: An STL, OBJ or Collada file.
        scale: Metres for one unit of the file.

    Raises:
        CellError: it cannot be read, has no triangles or no extent in one direction, or exceeds the limits.
    """
    trimesh = trimesh_module()
    if not file.is_file():
        raise CellError("there is no such mesh", where=str(file), hint="give its path relative to the document")
    verify_mesh_file(file)
    try:
        # Read from memory, so that a file cannot refer to other files.
        scene = trimesh.load_scene(BytesIO(file.read_bytes()), file_type=file.suffix[1:].lower())
        mesh: Any = scene.to_mesh()
    except Exception as error:
        # The readers behind trimesh have their own error classes for each format.
        raise CellError(f"the mesh cannot be read: {error}", where=str(file), hint="export it anew") from error
    require_triangles(len(mesh.faces), file)
    mesh.apply_scale(scale)
    mesh.merge_vertices(merge_norm=True, merge_tex=True)
    mesh.update_faces(mesh.nondegenerate_faces() & mesh.unique_faces())
    mesh.remove_unreferenced_vertices()
    size: Array = np.zeros(3) if mesh.is_empty else np.asarray(mesh.extents, np.float64)
    if not len(mesh.faces) or not np.isfinite(size).all() or size.min() <= 1e-9 * max(float(size.max()), 1e-9):
        raise CellError(
            "the mesh has no volume: its triangles are in one plane, or it has none",
            where=str(file),
            hint="export a solid, or use a box with `shape: box`",
        )
    pieces = [
        mesh.submesh([group], append=True)
        for group in trimesh.graph.connected_components(
            mesh.face_adjacency, nodes=np.arange(len(mesh.faces)), min_len=1
        )
    ]
    closed = [piece for piece in pieces if piece.is_watertight]
    rest = [piece for piece in pieces if not piece.is_watertight]
    edges = trimesh.grouping.group_rows(mesh.edges_sorted, require_count=1)
    solids = (*(_outwards(piece) for piece in closed), *((trimesh.util.concatenate(rest),) if rest else ()))
    return MeshSolids(solids=solids, size_m=size, open_edges=len(edges))


def inspect_mesh(file: Path, *, scale: float) -> tuple[MeshDefect, ...]:
    """Return what is wrong with a mesh file; nothing is decomposed."""
    try:
        read = read_solids(file, scale=scale)
    except CellError as error:
        return (MeshDefect(key="file", message=error.message, hint=error.hint or "", unusable=True),)
    defects: list[MeshDefect] = []
    if find_spec("coacd") is None:
        message = "a mesh with hollows is decomposed by the package `coacd`, which is not installed"
        defects.append(MeshDefect(key="file", message=message, hint=_EXTRA, unusable=False))
    largest = float(read.size_m.max())
    if not PLAUSIBLE_M[0] <= largest <= PLAUSIBLE_M[1]:
        size = " x ".join(f"{edge:.4g}" for edge in read.size_m)
        defects.append(
            MeshDefect(
                key="scale" if scale != 1.0 else "file",
                message=f"the mesh is {size} m large",
                hint=_unit_hint(largest / scale),
                unusable=False,
            )
        )
    if read.open_edges:
        message = f"the mesh is open at {read.open_edges} edges: it becomes a skin of about {largest / 100:.2g} m"
        hint = "close it in the program that made it, where that matters; a hollow stays hollow"
        defects.append(MeshDefect(key="file", message=message, hint=hint, unusable=False))
    return tuple(defects)


def _outwards(mesh: Any) -> Any:
    if mesh.volume < 0.0:
        mesh.invert()
    return mesh


def _unit_hint(largest: float) -> str:
    """Return the units in which a length, in units of the file, is plausible."""
    fitting = [f"`scale: {factor:g}` for {name}" for name, factor in _UNITS.items() if 0.01 <= largest * factor <= 5.0]
    return f"its numbers fit {' or '.join(fitting)}" if fitting else "give `scale`, the metres for one unit of the file"

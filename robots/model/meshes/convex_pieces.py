"""Decomposes a mesh file into convex pieces by CoACD, once for each content; later they come from the user's cache."""

from __future__ import annotations

import logging
from importlib import import_module
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.document import Decomposition
from engine.errors import CellError
from engine.host.user_cache import cache_dir
from engine.messages import Vector3
from robots.model.meshes.mesh_solids import PLAUSIBLE_M, read_solids
from robots.model.urdf.mesh_cache import content_key, read_cached, write_cached

Piece = tuple[Vector3, ...]
"""The corners of a convex piece, in metres, in the frame of the mesh."""

_log = logging.getLogger("flexcell.meshes")
_MOST_CORNERS = 64
# CoACD needs minutes for more, and a hollow does not show in single triangles.
_MOST_TRIANGLES = 4_000
_ANNOUNCED_FROM = 500
# A third of the search that CoACD does by itself: half the time for about as many pieces.
_SEARCH = {"mcts_nodes": 10, "mcts_iterations": 60}
# Of the size of a mesh that is implausibly large: one in the wrong unit would be searched for an hour.
_COARSE = 0.02
_RECIPE = "convex pieces 2"


def convex_pieces(
    file: Path, *, scale: float, decomposition: Decomposition | None = None, cache: Path | None = None
) -> tuple[Piece, ...]:
    """Return the convex pieces of a mesh file; the same content gives the same pieces.

    Args:
        file: An STL, OBJ or Collada file.
        scale: Metres for one unit of the file.
        decomposition: Limits of the pieces; its defaults by default.
        cache: The folder of the cache, the user's by default.

    Raises:
        CellError: the mesh cannot be read or has no volume, or is of more separate solids than pieces are allowed.
    """
    folder = cache if cache is not None else cache_dir()
    limits = decomposition if decomposition is not None else Decomposition()
    try:
        data = file.read_bytes()
    except OSError as error:
        reason = error.strerror or type(error).__name__
        hint = "give its path relative to the document"
        raise CellError(f"the mesh cannot be read: {reason}", where=str(file), hint=hint) from error
    options = (
        file.suffix.lower(),
        scale,
        limits.parts,
        limits.error_m,
        _MOST_CORNERS,
        _MOST_TRIANGLES,
        *_SEARCH.values(),
    )
    key = content_key(data, recipe=f"{_RECIPE} {options}")
    kept = read_cached(folder, key)
    if kept is not None:
        return msgspec.msgpack.decode(kept, type=tuple[Piece, ...])
    made = _decomposed(file, scale, limits)
    write_cached(folder, key, msgspec.msgpack.encode(made))
    return made


def _decomposed(file: Path, scale: float, limits: Decomposition) -> tuple[Piece, ...]:
    solids = read_solids(file, scale=scale).solids
    if len(solids) > limits.parts:
        raise CellError(
            f"the mesh is of {len(solids)} separate solids, and `decomposition` allows {limits.parts} pieces",
            where=str(file),
            hint=f"write `decomposition: {{parts: {len(solids)}}}` or more, or remove what is small from the mesh",
        )
    triangles = sum(len(solid.faces) for solid in solids)
    if triangles >= _ANNOUNCED_FROM:
        _log.warning("%s is decomposed into convex pieces, once: %d triangles take a while", file.name, triangles)
    pieces: list[Piece] = []
    for number, solid in enumerate(solids):
        left = limits.parts - len(pieces) - (len(solids) - number - 1)
        pieces += _pieces_of(solid, error_m=limits.error_m, most=left)
    return tuple(pieces)


def _pieces_of(solid: Any, *, error_m: float, most: int) -> list[Piece]:
    hull = solid.convex_hull
    is_convex = solid.is_watertight and solid.volume >= 0.999 * hull.volume
    if most == 1 or (is_convex and len(hull.vertices) <= _MOST_CORNERS):
        return [_corners(np.asarray(hull.vertices, np.float64))]
    coacd = _coacd()
    points, faces = _simplified(solid)
    size_m = float(solid.extents.max())
    coarsest_m = _COARSE * size_m if size_m > PLAUSIBLE_M[1] else 0.0
    found: list[tuple[Any, Any]] = coacd.run_coacd(
        coacd.Mesh(points, faces),
        threshold=max(error_m, coarsest_m),
        real_metric=True,
        max_convex_hull=most,
        decimate=True,
        max_ch_vertex=_MOST_CORNERS,
        **_SEARCH,
        seed=0,
    )
    return [_corners(np.asarray(corners, np.float64)) for corners, _ in found]


def _simplified(solid: Any) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    points, faces = np.asarray(solid.vertices, np.float64), np.asarray(solid.faces, np.int32)
    if len(faces) <= _MOST_TRIANGLES:
        return points, faces
    fast_simplification: Any = import_module("fast_simplification")
    fewer, triangles = fast_simplification.simplify(points, faces, target_count=_MOST_TRIANGLES)
    return np.asarray(fewer, np.float64), np.asarray(triangles, np.int32)


def _coacd() -> Any:
    try:
        # 13 MB, and needed only on a cache miss; it has no types.
        coacd = import_module("coacd")
    except ImportError as error:
        raise CellError(
            "meshes with hollows are decomposed by the package `coacd`, which is not installed",
            hint="pip install 'flexcell[sim]'",
        ) from error
    coacd.set_log_level("error")
    return coacd


def _corners(points: NDArray[np.float64]) -> Piece:
    # A nanometre is enough, and equal numbers on all machines make equal worlds.
    return tuple((x, y, z) for x, y, z in points.round(9).tolist())

"""The occupied voxels of `cell/occupancy` as squares, coloured by height; only voxels on the surface."""

from __future__ import annotations

import logging
import math

import numpy as np
from numpy.typing import NDArray

from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.colours import ramp
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from editor_web.cell_view.rendering.voxel_squares import VoxelSquares
from engine.messages.sensing import OccupancyGrid

_log = logging.getLogger("flexcell.cell_view")
PERIOD_S = 0.1
# viser's size is half an edge; a gap between neighbours makes single voxels visible.
_POINT_SHARE = 0.46
_HEIGHTS = ((68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37))
"""Viridis: distinguishable with colour blindness and in greyscale."""
_STALE = ((90, 90, 90), (170, 170, 170))


def occupied(grid: OccupancyGrid) -> NDArray[np.bool_]:
    """Return the occupancy of each voxel, in the grid's shape.

    Raises:
        ValueError: the number of bits does not match the shape.
    """
    count = math.prod(grid.shape)
    bits = np.frombuffer(grid.occupied, dtype=np.uint8)
    if min(grid.shape) < 0 or len(bits) != (count + 7) // 8:
        raise ValueError(f"{len(bits)} bytes do not match a grid of {grid.shape} voxels")
    return np.unpackbits(bits, count=count).astype(np.bool_).reshape(grid.shape)


def surface(filled: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the occupied voxels with at least one free face neighbour; space outside the grid is free."""
    inside = filled.copy()
    for axis in range(3):
        rows = np.moveaxis(inside, axis, 0)
        of = np.moveaxis(filled, axis, 0)
        rows[1:] &= of[:-1]
        rows[:-1] &= of[1:]
        rows[:1] = False
        rows[-1:] = False
    return filled & ~inside


class VoxelLayer:
    """Draws the latest grid on changes, at most ten times a second; grey if it is out of date."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._squares = VoxelSquares(server, f"{root_of('voxels', under=under)}/occupied", share=_POINT_SHARE)
        self._drawn: tuple[OccupancyGrid, bool] | None = None
        self._next_s = 0.0

    def draw(self, latest: LatestMessages, now_s: float) -> float | None:
        """Draw the changes; return the time of the next call if it is too early now."""
        grid, state = latest.occupancy, latest.occupancy_state
        is_stale = state is not None and state.stale_reason != ""
        if grid is None or (self._drawn is not None and self._drawn[0] is grid and self._drawn[1] == is_stale):
            return None
        if now_s < self._next_s:
            return self._next_s
        self._drawn, self._next_s = (grid, is_stale), now_s + PERIOD_S
        try:
            places = np.argwhere(surface(occupied(grid)))
        except ValueError as error:
            _log.warning("the occupancy is not drawn: %s", error)
            return None
        stops = _STALE if is_stale else _HEIGHTS
        shades = ramp(stops, np.linspace(0.0, 1.0, max(1, grid.shape[2])))[places[:, 2]]
        self._squares.show(places, shades, voxel_m=grid.voxel_m, corner_m=grid.corner_m)
        return None

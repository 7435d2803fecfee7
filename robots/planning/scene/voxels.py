"""The occupancy map for planners: a distance field for the compiled core, an octree for the exact checker."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from engine.errors import CellError
from engine.messages.sensing import OccupancyGrid
from robots.model.transform import RigidTransform
from robots.planning.scene.coal_shapes import coal
from robots.planning.scene.compiled_problem import CORNER, FARTHEST, GRID_COLUMNS, HIGH, LOW, VOXEL
from robots.port import Array

_REACH = 12
_KEPT = 3


@dataclass(frozen=True, kw_only=True)
class Voxels:
    """Cubes along the world's axes: which are occupied, (x, y, z) of 0 and 1, and the parameters of their grid."""

    taken: NDArray[np.uint8]
    grid: Array
    """(GRID_COLUMNS,) in the form of `voxel_distance_kernels`"""

    @property
    def any(self) -> bool:
        """True if any voxel is occupied."""
        return bool(self.grid[LOW] <= self.grid[HIGH])

    @property
    def corner(self) -> RigidTransform:
        """The lowest corner of the grid in the world."""
        return RigidTransform.of(self.grid[CORNER : CORNER + 3], (0.0, 0.0, 0.0, 1.0))

    @cached_property
    def field(self) -> NDArray[np.float32]:
        """The distance of each voxel's center from the nearest occupied cube, (x, y, z), truncated."""
        from robots.planning.scene.voxel_distance_kernels import distance_field

        return distance_field(self.taken, float(self.grid[VOXEL]), _REACH)

    @cached_property
    def octree(self) -> Any:
        """Coal's octree, in the frame of `corner`; requires an occupied voxel."""
        edge = float(self.grid[VOXEL])
        return coal.makeOctree((np.argwhere(self.taken) + 0.5) * edge, edge)


def voxels_of(grid: OccupancyGrid) -> Voxels:
    """Return the voxels of an occupancy message.

    Raises:
        CellError: the numbers of the message are inconsistent.
    """
    count = int(np.prod(grid.shape))
    if min(grid.shape) < 1 or not grid.voxel_m > 0.0 or len(grid.occupied) != -(-count // 8):
        raise CellError(
            f"{len(grid.occupied)} bytes are not the occupancy of {list(grid.shape)} voxels of {grid.voxel_m} m",
            where="occupancy",
            hint="one bit per voxel, packed as by numpy.packbits",
        )
    bits = np.unpackbits(np.frombuffer(grid.occupied, dtype=np.uint8), count=count)
    taken = bits.reshape(grid.shape)
    numbers = np.empty(GRID_COLUMNS)
    numbers[CORNER:VOXEL], numbers[VOXEL] = grid.corner_m, grid.voxel_m
    numbers[FARTHEST] = np.float32((_REACH - 0.5) * grid.voxel_m * (1.0 - 1e-6))
    numbers[LOW:HIGH], numbers[HIGH:] = np.inf, -np.inf
    if bits.any():
        sides = [np.flatnonzero(taken.any(axis=axes)) for axes in ((1, 2), (0, 2), (0, 1))]
        numbers[LOW:HIGH] = np.array(grid.corner_m) + grid.voxel_m * np.array([side[0] for side in sides])
        numbers[HIGH:] = np.array(grid.corner_m) + grid.voxel_m * np.array([side[-1] + 1 for side in sides])
    return Voxels(taken=taken, grid=numbers)


class VoxelCache:
    """Caches the voxels of the latest grids."""

    def __init__(self) -> None:
        self._kept: OrderedDict[OccupancyGrid, Voxels] = OrderedDict()

    def of(self, grid: OccupancyGrid | None) -> Voxels | None:
        """Return a grid's voxels, None without a grid or without occupied voxels."""
        if grid is None:
            return None
        voxels = self._kept.pop(grid, None) or voxels_of(grid)
        self._kept[grid] = voxels
        if len(self._kept) > _KEPT:
            self._kept.popitem(last=False)
        return voxels if voxels.any else None

"""The mapped box of voxels."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from engine.document import OccupancyMap
from engine.errors import CellError
from engine.messages import Vector3
from engine.messages.sensing import OccupancyGrid
from robots.port import Array

_MOST_VOXELS = 20_000_000
# Tolerance for sizes that are a whole number of voxels except for rounding.
_ROUNDING = 1e-6


class VoxelBox(msgspec.Struct, frozen=True, kw_only=True):
    """An axis-aligned box from `corner_m` on, divided into cubes; margins and age limit as in the cell document."""

    corner_m: Vector3
    voxel_m: float
    shape: tuple[int, int, int]
    robot_margin_m: float
    known_margin_m: float
    seen_within_s: float = 5.0

    @property
    def reach_m(self) -> float:
        """Distance from the centre of a voxel to its corners."""
        return self.voxel_m * math.sqrt(3.0) / 2.0

    @property
    def middle_m(self) -> Vector3:
        """Centre of the box."""
        x, y, z = (a + self.voxel_m * count / 2.0 for a, count in zip(self.corner_m, self.shape, strict=True))
        return (x, y, z)

    def centres(self, low: tuple[int, int, int], high: tuple[int, int, int]) -> Array:
        """Return the centres of the voxels from `low` to before `high`, (k, 3), z fastest."""
        axes: list[Array] = [
            corner + self.voxel_m * (np.arange(a, b, dtype=np.float64) + 0.5)
            for corner, a, b in zip(self.corner_m, low, high, strict=True)
        ]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3).astype(np.float64)


def voxel_box(occupancy: OccupancyMap) -> VoxelBox:
    """Return the box of a cell document, enlarged to a whole number of voxels.

    Raises:
        CellError: it has more voxels than can be updated in time.
    """
    voxel = occupancy.voxel_m
    x, y, z = (max(1, math.ceil(size / voxel - _ROUNDING)) for size in occupancy.size_m)
    if x * y * z > _MOST_VOXELS:
        raise CellError(
            f"{x} x {y} x {z} voxels exceed the limit of {_MOST_VOXELS}",
            where="occupancy",
            hint="make the box smaller or the voxels larger",
        )
    cx, cy, cz = occupancy.center_m
    return VoxelBox(
        corner_m=(cx - x * voxel / 2.0, cy - y * voxel / 2.0, cz - z * voxel / 2.0),
        voxel_m=voxel,
        shape=(x, y, z),
        robot_margin_m=occupancy.robot_margin_m,
        known_margin_m=occupancy.known_margin_m,
        seen_within_s=occupancy.seen_within_s,
    )


def occupied_centres(grid: OccupancyGrid) -> Array:
    """Return the centres of the occupied voxels of a map, (k, 3), world."""
    x, y, z = grid.shape
    bits = np.unpackbits(np.frombuffer(grid.occupied, dtype=np.uint8), count=x * y * z)
    indices = np.argwhere(bits.reshape(grid.shape)).astype(np.float64)
    return (indices + 0.5) * grid.voxel_m + np.array(grid.corner_m)

"""An occupancy map in which all that is near something occupied is occupied too."""

from __future__ import annotations

import msgspec
import numpy as np

from engine.messages.sensing import OccupancyGrid
from robots.port import Array


def inflated(grid: OccupancyGrid, distance_m: float) -> OccupancyGrid:
    """Return a map in which each voxel with its centre within `distance_m` of that of an occupied one is occupied."""
    # Imported here: it loads compiled code, for cells with cameras only.
    from scipy.ndimage import distance_transform_edt  # pyright: ignore[reportUnknownVariableType]

    x, y, z = grid.shape
    bits = np.unpackbits(np.frombuffer(grid.occupied, dtype=np.uint8), count=x * y * z).reshape(grid.shape)
    if not bits.any():
        return grid
    apart_m: Array = np.asarray(distance_transform_edt(bits == 0, sampling=grid.voxel_m), dtype=np.float64)
    return msgspec.structs.replace(grid, occupied=np.packbits(apart_m <= distance_m).tobytes())

"""Which voxels of the mapped box are unknown: not seen by a camera within the limit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.errors import CellError
from engine.messages.sensing import ObservedSpace
from robots.planning.swept_space import CoverRegion


def unknown_voxels(observed: ObservedSpace, regions: tuple[CoverRegion, ...] = ()) -> NDArray[np.uint8]:
    """Return 1 for each voxel that was not seen within the limit, (x, y, z); with regions only inside one of them.

    Raises:
        CellError: the numbers of the message are inconsistent.
    """
    ages = np.frombuffer(observed.ages, dtype=np.uint8)
    if min(observed.shape) < 1 or not observed.voxel_m > 0.0 or len(ages) != int(np.prod(observed.shape)):
        raise CellError(
            f"{len(ages)} bytes are not the ages of {list(observed.shape)} voxels of {observed.voxel_m} m",
            where="occupancy",
            hint="give one byte per voxel",
        )
    unknown = (ages > observed.greatest_known_age).astype(np.uint8).reshape(observed.shape)
    if not regions:
        return unknown
    counted = np.zeros_like(unknown)
    for region in regions:
        counted[region_voxels(observed, region)] = 1
    return unknown & counted


def region_voxels(observed: ObservedSpace, region: CoverRegion) -> tuple[slice, slice, slice]:
    """Return the voxels whose centres are in a region."""
    spans: list[slice] = []
    for corner, count, centre, edge in zip(
        observed.corner_m, observed.shape, region.center_m, region.size_m, strict=True
    ):
        low = (centre - edge / 2.0 - corner) / observed.voxel_m - 0.5
        high = (centre + edge / 2.0 - corner) / observed.voxel_m - 0.5
        spans.append(slice(min(max(int(np.ceil(low)), 0), count), min(max(int(np.floor(high)) + 1, 0), count)))
    return spans[0], spans[1], spans[2]

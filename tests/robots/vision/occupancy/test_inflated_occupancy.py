"""An inflated map holds exactly the voxels whose centres are within the distance of an occupied one."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from engine.messages.sensing import OccupancyGrid
from robots.vision.occupancy.inflated_occupancy import inflated

SHAPE, VOXEL_M = (5, 7, 4), 0.05
_VOXELS = 5 * 7 * 4


def _grid(occupied: frozenset[int]) -> OccupancyGrid:
    bits = np.zeros(_VOXELS, dtype=np.uint8)
    bits[list(occupied)] = 1
    return OccupancyGrid(
        time_s=0.0,
        revision=3,
        corner_m=(0.0, 0.0, 0.0),
        voxel_m=VOXEL_M,
        shape=SHAPE,
        occupied=np.packbits(bits).tobytes(),
    )


@given(
    st.frozensets(st.integers(0, _VOXELS - 1), max_size=6),
    st.floats(0.0, 0.4, exclude_min=True).filter(lambda far: abs((far / VOXEL_M) ** 2 % 1.0 - 0.5) < 0.49),
)
def test_what_is_within_the_distance_is_occupied_and_nothing_else(occupied: frozenset[int], distance_m: float) -> None:
    got = inflated(_grid(occupied), distance_m)
    centres = np.argwhere(np.ones(SHAPE, dtype=bool)) * VOXEL_M
    expected = [any(np.linalg.norm(one - centres[other]) <= distance_m for other in occupied) for one in centres]
    bits = np.unpackbits(np.frombuffer(got.occupied, dtype=np.uint8), count=_VOXELS)
    assert bits.astype(bool).tolist() == expected
    assert (got.shape, got.revision) == (SHAPE, 3)

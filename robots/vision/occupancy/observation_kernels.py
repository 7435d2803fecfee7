"""The compiled steps of the map of observed space: which voxels a camera sees, and how long ago each was seen.

Voxels and cameras are as in `occupancy_kernels`. Times are in hundredths of a second, below 0 for never.
"""

from __future__ import annotations

from engine.messages.sensing import LONG_UNSEEN, NEVER_SEEN
from robots.compiled import compiled
from robots.port import Array
from robots.vision.cameras.camera import Image
from robots.vision.occupancy.occupancy_kernels import Bytes, Counts

NEVER = -1
_TENTH = 10


@compiled()
def mark_seen(
    depth: Image,
    lens: Array,
    turn: Array,
    place: Array,
    corner: Array,
    voxel: float,
    shape: Counts,
    within: float,
    far: float,
    at: int,
    seen: Counts,
) -> None:
    """Set the time to `at` for the voxels up to `far` whose centre the camera sees: it measures nothing before it.

    Measured surfaces may be nearer than the centre by `within`.
    """
    height, width = depth.shape
    nx, ny, nz = shape[0], shape[1], shape[2]
    step_u, step_v, step_w = turn[2, 0] * voxel, turn[2, 1] * voxel, turn[2, 2] * voxel
    z0 = corner[2] + 0.5 * voxel - place[2]
    for i in range(nx):
        x = corner[0] + (i + 0.5) * voxel - place[0]
        for j in range(ny):
            y = corner[1] + (j + 0.5) * voxel - place[1]
            across = turn[0, 0] * x + turn[1, 0] * y + turn[2, 0] * z0
            down = turn[0, 1] * x + turn[1, 1] * y + turn[2, 1] * z0
            away = turn[0, 2] * x + turn[1, 2] * y + turn[2, 2] * z0
            row = (i * ny + j) * nz
            for k in range(nz):
                if voxel <= away <= far:
                    u = lens[2] + lens[0] * across / away
                    v = lens[3] + lens[1] * down / away
                    if u > -0.5 and v > -0.5 and u < width - 0.5 and v < height - 0.5:
                        z = depth[int(v + 0.5), int(u + 0.5)]
                        # 0, not measured, shows nothing; what is not a number neither.
                        if z > 0.0 and z >= away - within:
                            seen[row + k] = max(seen[row + k], at)
                across += step_u
                down += step_v
                away += step_w


@compiled()
def write_ages(seen: Counts, taken: Bytes, now: int, ages: Bytes) -> None:
    """Write the age of each voxel as in `ObservedSpace`; known voxels have the age 0."""
    for i in range(len(seen)):
        if taken[i] != 0:
            ages[i] = 0
        elif seen[i] < 0:
            ages[i] = NEVER_SEEN
        else:
            ages[i] = min(max((now - seen[i]) // _TENTH, 0), LONG_UNSEEN)

"""The compiled search for the unknown voxels that an arm's spheres pass through."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.search.geometry_kernels import joint_frames, place
from robots.port import Array

Bytes = NDArray[np.uint8]
Indices = NDArray[np.int64]

UNKNOWN, SWEPT = 1, 2


@compiled()
def sweep(
    p: CompiledProblem,
    rows: Array,
    step_m: float,
    near_m: float,
    corner: Array,
    voxel: float,
    shape: Indices,
    state: Bytes,
    found: Indices,
    at_row: Indices,
) -> int:
    """Write the UNKNOWN voxels of `state` inside the spheres along rows (k, n), in their order, and the row of each.

    Return their number. Found voxels become SWEPT; those within `near_m` of the spheres at the first row become known
    beforehand. No point moves farther than `step_m` between two checks.
    """
    frames = np.empty((rows.shape[1] + 2, 12))
    centres = np.empty((len(p.spheres), 3))
    q = rows[0].copy()
    joint_frames(p.placements, p.sliding, q, frames)
    for link in range(len(p.link_joint)):
        place(frames, p.link_joint[link], p.spheres, p.first_sphere[link], p.first_sphere[link + 1], centres)
    for s in range(len(centres)):
        _mark(centres[s], p.spheres[s, 3] + near_m, corner, voxel, shape, state, 0, found, at_row, 0, 0)
    count = 0
    for k in range(1, len(rows)):
        distance = 0.0
        for j in range(rows.shape[1]):
            distance += abs(rows[k, j] - q[j]) * p.bound[j]
        if distance < step_m and k < len(rows) - 1:
            continue
        start = q.copy()
        steps = max(1, math.ceil(distance / step_m))
        for i in range(1, steps + 1):
            for j in range(rows.shape[1]):
                q[j] = start[j] + (rows[k, j] - start[j]) * (i / steps)
            joint_frames(p.placements, p.sliding, q, frames)
            for link in range(len(p.link_joint)):
                if p.link_joint[link] > 0:
                    first, last = p.first_sphere[link], p.first_sphere[link + 1]
                    place(frames, p.link_joint[link], p.spheres, first, last, centres)
                    for s in range(first, last):
                        radius = p.spheres[s, 3]
                        count = _mark(centres[s], radius, corner, voxel, shape, state, SWEPT, found, at_row, count, k)
    return count


@compiled()
def _mark(
    centre: Array,
    radius: float,
    corner: Array,
    voxel: float,
    shape: Indices,
    state: Bytes,
    value: int,
    found: Indices,
    at_row: Indices,
    count: int,
    row: int,
) -> int:
    """Give the UNKNOWN voxels whose centre is in a sphere the state `value`; write them if that is SWEPT."""
    x, y, z = centre[0] - corner[0], centre[1] - corner[1], centre[2] - corner[2]
    low0, high0 = max(math.floor((x - radius) / voxel), 0), min(math.floor((x + radius) / voxel) + 1, shape[0])
    low1, high1 = max(math.floor((y - radius) / voxel), 0), min(math.floor((y + radius) / voxel) + 1, shape[1])
    low2, high2 = max(math.floor((z - radius) / voxel), 0), min(math.floor((z + radius) / voxel) + 1, shape[2])
    square = radius * radius
    for i in range(low0, high0):
        dx = (i + 0.5) * voxel - x
        for j in range(low1, high1):
            dy = (j + 0.5) * voxel - y
            if dx * dx + dy * dy > square:
                continue
            first = (i * shape[1] + j) * shape[2]
            for k in range(low2, high2):
                if state[first + k] != UNKNOWN:
                    continue
                dz = (k + 0.5) * voxel - z
                if dx * dx + dy * dy + dz * dz <= square:
                    state[first + k] = value
                    if value == SWEPT:
                        found[count] = first + k
                        at_row[count] = row
                        count += 1
    return count

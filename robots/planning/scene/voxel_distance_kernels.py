"""Compiled voxel distances: of every voxel from the nearest occupied one, and of spheres from occupied voxels.

An occupied voxel is a cube. Distances of spheres from cubes are exact: the distance field decides at once for most
spheres, which are far away or inside; only for the rest are the nearby cubes checked.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.planning.scene.compiled_problem import CORNER, FARTHEST, HIGH, LOW, VOXEL
from robots.port import Array

Field = NDArray[np.float32]

# Larger than the rounding error of single precision, meters.
_ROUNDING_M = 1e-5


@compiled()
def distance_field(taken: NDArray[np.uint8], voxel_m: float, reach: int) -> Field:
    """Return the distance of each voxel's center from the nearest occupied cube, meters, 0 inside.

    Truncated at `reach` voxels to (reach - 0.5) edges. Exact otherwise: the squared distance is
    a sum over the axes, with one pass over the array per axis.
    """
    nx, ny, nz = taken.shape
    farthest = np.float32((reach - 0.5) ** 2)
    steps = np.empty(reach + 1, dtype=np.float32)
    steps[0] = 0.0
    for k in range(1, reach + 1):
        steps[k] = (k - 0.5) ** 2
    rows = np.full((nx, ny, nz), farthest, dtype=np.float32)
    is_near = np.zeros((nx, ny), dtype=np.bool_)
    for x in range(nx):
        for y in range(ny):
            row, bits = rows[x, y], taken[x, y]
            last = -reach - 1
            for z in range(nz):
                if bits[z]:
                    is_near[x, y], last = True, z
                if z - last < reach:
                    row[z] = steps[z - last]
            if is_near[x, y]:
                last = nz + reach + 1
                for z in range(nz - 1, -1, -1):
                    if bits[z]:
                        last = z
                    if last - z < reach:
                        row[z] = min(row[z], steps[last - z])
    across = np.full((nx, ny, nz), farthest, dtype=np.float32)
    is_near_across = np.zeros((nx, ny), dtype=np.bool_)
    for x in range(nx):
        for y in range(ny):
            if is_near[x, y]:
                for other in range(max(0, y - reach + 1), min(ny, y + reach)):
                    is_near_across[x, other] = True
                    _lower(across[x, other], rows[x, y], steps[abs(other - y)])
    out = np.full((nx, ny, nz), farthest, dtype=np.float32)
    for x in range(nx):
        for other in range(max(0, x - reach + 1), min(nx, x + reach)):
            step = steps[abs(other - x)]
            for y in range(ny):
                if is_near_across[x, y]:
                    _lower(out[other, y], across[x, y], step)
    flat = out.ravel()
    for i in range(len(flat)):
        flat[i] = math.sqrt(flat[i]) * voxel_m
    return out


@compiled()
def _lower(row: Field, other: Field, step: float) -> None:
    add = np.float32(step)
    for z in range(len(row)):
        row[z] = min(row[z], other[z] + add)


@compiled()
def _bounds(field: Field, grid: Array, x: float, y: float, z: float) -> tuple[float, float]:
    """Return bounds of the distance of a point from the nearest occupied cube; the upper is infinite if unknown."""
    h = grid[VOXEL]
    nx, ny, nz = field.shape
    u, v, w = (x - grid[CORNER]) / h, (y - grid[CORNER + 1]) / h, (z - grid[CORNER + 2]) / h
    # The nearest point of the grid, and its voxel.
    a, b, c = min(max(u, 0.0), float(nx)), min(max(v, 0.0), float(ny)), min(max(w, 0.0), float(nz))
    i, j, k = min(int(a), nx - 1), min(int(b), ny - 1), min(int(c), nz - 1)
    du, dv, dw = a - i - 0.5, b - j - 0.5, c - k - 0.5
    away = math.sqrt(du * du + dv * dv + dw * dw) * h
    outside = math.sqrt((u - a) ** 2 + (v - b) ** 2 + (w - c) ** 2) * h
    at = float(field[i, j, k])
    least = max(at - away, 0.0)
    # All cubes are within the grid: seen from its nearest point, none is on the outer side.
    least = math.sqrt(least * least + outside * outside) - _ROUNDING_M
    return least, outside + at + away + _ROUNDING_M if at < grid[FARTHEST] else math.inf


@compiled()
def _cube_distance(field: Field, grid: Array, x: float, y: float, z: float, reach: float, any_: bool) -> float:
    """Return the distance of a point to the nearest occupied cube, at most `reach`; any nearer one if `any_`."""
    h = grid[VOXEL]
    nx, ny, nz = field.shape
    u, v, w, r = (x - grid[CORNER]) / h, (y - grid[CORNER + 1]) / h, (z - grid[CORNER + 2]) / h, reach / h
    best = r * r
    for i in range(max(0, math.floor(u - r)), min(nx, math.floor(u + r) + 1)):
        dx = max(i - u, u - i - 1.0, 0.0)
        if dx * dx >= best:
            continue
        for j in range(max(0, math.floor(v - r)), min(ny, math.floor(v + r) + 1)):
            dy = max(j - v, v - j - 1.0, 0.0)
            side = dx * dx + dy * dy
            if side >= best:
                continue
            k, last = max(0, math.floor(w - r)), min(nz, math.floor(w + r) + 1)
            while k < last:
                free = field[i, j, k]
                if free > 0.0:
                    # The nearest occupied cube begins at that distance from the center of this one.
                    k += max(1, math.ceil(free / h + 0.49))
                    continue
                dz = max(k - w, w - k - 1.0, 0.0)
                if side + dz * dz < best:
                    best = side + dz * dz
                    if any_:
                        return math.sqrt(best) * h
                k += 1
    return math.sqrt(best) * h


@compiled()
def is_ball_far(balls: Array, ball: int, field: Field, grid: Array, reach: float) -> bool:
    """Return whether a bounding sphere (center, radius) is certainly farther than `reach` from all occupied cubes."""
    least, _ = _bounds(field, grid, balls[ball, 0], balls[ball, 1], balls[ball, 2])
    return least >= reach + balls[ball, 3]


@compiled()
def is_voxel_nearer(
    points: Array, radii: Array, first: int, last: int, field: Field, grid: Array, reach: float
) -> bool:
    """Return whether any of the spheres `first` … `last` - 1 is nearer than `reach` to an occupied cube."""
    nx, ny, nz = field.shape
    per_m, half = 1.0 / grid[VOXEL], 0.8661 * grid[VOXEL]
    cx, cy, cz = grid[CORNER], grid[CORNER + 1], grid[CORNER + 2]
    for s in range(first, last):
        limit = reach + radii[s, 3]
        if limit <= 0.0:
            continue
        x, y, z = points[s, 0], points[s, 1], points[s, 2]
        u, v, w = (x - cx) * per_m, (y - cy) * per_m, (z - cz) * per_m
        # Decides nearly always: nothing in a voxel is farther from its center than half of its diagonal.
        inside = 0.0 <= u < nx and 0.0 <= v < ny and 0.0 <= w < nz
        if inside and field[int(u), int(v), int(w)] >= limit + half:
            continue
        dx = max(grid[LOW] - x, x - grid[HIGH], 0.0)
        dy = max(grid[LOW + 1] - y, y - grid[HIGH + 1], 0.0)
        dz = max(grid[LOW + 2] - z, z - grid[HIGH + 2], 0.0)
        if dx * dx + dy * dy + dz * dz >= limit * limit:
            continue
        least, most = _bounds(field, grid, x, y, z)
        if least >= limit:
            continue
        if most < limit or _cube_distance(field, grid, x, y, z, limit, True) < limit:
            return True
    return False


@compiled()
def voxel_gap(points: Array, radii: Array, first: int, last: int, field: Field, grid: Array, enough: float) -> float:
    """Return the smallest distance of spheres from an occupied cube, at most `enough`.

    Beyond the truncation of the distance field, returns a lower bound.
    """
    gap = enough
    for s in range(first, last):
        _, most = _bounds(field, grid, points[s, 0], points[s, 1], points[s, 2])
        gap = min(gap, most - radii[s, 3])
    for s in range(first, last):
        x, y, z, radius = points[s, 0], points[s, 1], points[s, 2], radii[s, 3]
        least, most = _bounds(field, grid, x, y, z)
        if least - radius >= gap or gap + radius <= 0.0:
            continue
        if most < math.inf:
            gap = min(gap, _cube_distance(field, grid, x, y, z, min(most, gap + radius), False) - radius)
        else:
            gap = least - radius
    return gap

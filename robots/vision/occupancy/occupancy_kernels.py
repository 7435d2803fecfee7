"""The compiled steps of the occupancy map: count measured points in voxels, look through voxels, apply the evidence.

Voxels are flat arrays, z fastest. A camera is `lens` (fx, fy, cx, cy), its rotation (3, 3) and its position (3,) in
the world. `taken` is the known occupancy of a voxel: nothing (0), something near (1), fully occupied (2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.port import Array
from robots.vision.cameras.camera import Image

Bytes = NDArray[np.uint8]
Counts = NDArray[np.int32]

FREE, BESIDE, NEAR, INSIDE = 0, 1, 2, 3
WEAK, STRONG = 1, 2
_NEW = 2


@compiled()
def count_hits(
    depth: Image,
    lens: Array,
    turn: Array,
    place: Array,
    corner: Array,
    voxel: float,
    shape: Counts,
    taken: Bytes,
    counts: Counts,
    touched: Counts,
) -> int:
    """Count the measured points in each voxel free of known geometry; return the number of `touched` voxels."""
    height, width = depth.shape
    nx, ny, nz = shape[0], shape[1], shape[2]
    scale = 1.0 / voxel
    x0, y0, z0 = (place[0] - corner[0]) * scale, (place[1] - corner[1]) * scale, (place[2] - corner[2]) * scale
    found = 0
    for v in range(height):
        down = (v - lens[3]) / lens[1]
        # The direction of a pixel, in voxels for each metre of depth, is a + u b.
        ax = (turn[0, 1] * down + turn[0, 2]) * scale
        ay = (turn[1, 1] * down + turn[1, 2]) * scale
        az = (turn[2, 1] * down + turn[2, 2]) * scale
        for u in range(width):
            z = depth[v, u]
            # Written so that what is not a number is left out too.
            if not (z > 0.0 and z < 1e3):
                continue
            across = (u - lens[2]) / lens[0]
            x = x0 + z * (ax + turn[0, 0] * across * scale)
            y = y0 + z * (ay + turn[1, 0] * across * scale)
            h = z0 + z * (az + turn[2, 0] * across * scale)
            if not (x >= 0.0 and y >= 0.0 and h >= 0.0 and x < nx and y < ny and h < nz):
                continue
            index = (int(x) * ny + int(y)) * nz + int(h)
            if taken[index] != FREE:
                continue
            if counts[index] == 0:
                touched[found] = index
                found += 1
            counts[index] += 1
    return found


@compiled()
def grade_hits(
    touched: Counts,
    found: int,
    counts: Counts,
    lens: Array,
    turn: Array,
    place: Array,
    corner: Array,
    voxel: float,
    shape: Counts,
    share: float,
    levels: Bytes,
    hit: Counts,
    hits: int,
) -> int:
    """Grade a camera's touched voxels by the share of the pixels that a whole voxel would fill; clear the counts."""
    ny, nz = shape[1], shape[2]
    for i in range(found):
        index = touched[i]
        x = corner[0] + (index // (ny * nz) + 0.5) * voxel - place[0]
        y = corner[1] + (index // nz % ny + 0.5) * voxel - place[1]
        h = corner[2] + (index % nz + 0.5) * voxel - place[2]
        away = max(turn[0, 2] * x + turn[1, 2] * y + turn[2, 2] * h, voxel)
        whole = lens[0] * lens[1] * (voxel / away) ** 2
        level = STRONG if counts[index] >= share * whole else WEAK
        counts[index] = 0
        if levels[index] == 0:
            hit[hits] = index
            hits += 1
        levels[index] = max(levels[index], level)
    return hits


@compiled()
def look_through(
    filled: NDArray[np.int64],
    depth: Image,
    lens: Array,
    turn: Array,
    place: Array,
    corner: Array,
    voxel: float,
    shape: Counts,
    beyond: float,
    through: Bytes,
) -> None:
    """Mark those of the `filled` voxels behind whose centre, by more than `beyond`, the camera measures something."""
    height, width = depth.shape
    ny, nz = shape[1], shape[2]
    for i in range(len(filled)):
        index = filled[i]
        x = corner[0] + (index // (ny * nz) + 0.5) * voxel - place[0]
        y = corner[1] + (index // nz % ny + 0.5) * voxel - place[1]
        h = corner[2] + (index % nz + 0.5) * voxel - place[2]
        away = turn[0, 2] * x + turn[1, 2] * y + turn[2, 2] * h
        if away < voxel:
            continue
        u = lens[2] + lens[0] * (turn[0, 0] * x + turn[1, 0] * y + turn[2, 0] * h) / away
        v = lens[3] + lens[1] * (turn[0, 1] * x + turn[1, 1] * y + turn[2, 1] * h) / away
        if not (u > -0.5 and v > -0.5 and u < width - 0.5 and v < height - 0.5):
            continue
        z = depth[int(v + 0.5), int(u + 0.5)]
        if z > away + beyond and (z < 1e3 or z == np.inf):
            through[i] = 1


@compiled()
def _neighbours(index: int, shape: Counts, levels: Bytes, least: int) -> int:
    """Return how many of the 26 voxels around one were hit at `least` so well."""
    nx, ny, nz = shape[0], shape[1], shape[2]
    x, y, z = index // (ny * nz), index // nz % ny, index % nz
    found = 0
    for i in range(max(x - 1, 0), min(x + 2, nx)):
        for j in range(max(y - 1, 0), min(y + 2, ny)):
            for k in range(max(z - 1, 0), min(z + 2, nz)):
                other = (i * ny + j) * nz + k
                if other != index and levels[other] >= least:
                    found += 1
    return found


@compiled()
def _grows(index: int, shape: Counts, levels: Bytes, full: Bytes) -> bool:
    """Return whether one of the 26 voxels around one was full before and is hit now."""
    nx, ny, nz = shape[0], shape[1], shape[2]
    x, y, z = index // (ny * nz), index // nz % ny, index % nz
    for i in range(max(x - 1, 0), min(x + 2, nx)):
        for j in range(max(y - 1, 0), min(y + 2, ny)):
            for k in range(max(z - 1, 0), min(z + 2, nz)):
                other = (i * ny + j) * nz + k
                if full[other] == 1 and levels[other] > 0:
                    return True
    return False


@compiled()
def apply_evidence(
    hit: Counts,
    hits: int,
    levels: Bytes,
    filled: NDArray[np.int64],
    through: Bytes,
    taken: Bytes,
    shape: Counts,
    company: int,
    edge_images: int,
    lone_images: int,
    misses_to_clear: int,
    misses_beside: int,
    full: Bytes,
    misses: Bytes,
    streak: Bytes,
    waiting: Counts,
    waits: int,
) -> int:
    """Fill and clear voxels by this image's evidence; return how many, in `waiting`, need more of it.

    Well hit with neighbours: filled at once, or after `edge_images` next to filled voxels. Well hit
    alone, or weakly next to a well hit one: filled after `lone_images` consecutive images. Looked through,
    and not hit, `misses_to_clear` times: cleared, or `misses_beside` times next to a well hit
    voxel, as at the edges of objects. `through` refers to the `filled`, then to the `waiting`.
    """
    waited, waits = waits, 0
    for i in range(waited):
        index = waiting[i]
        if levels[index] != 0:
            continue
        if through[len(filled) + i] or taken[index] != FREE:
            streak[index] = 0
        else:
            # No image showed this place.
            waiting[waits] = index
            waits += 1
    for i in range(hits):
        index = hit[i]
        misses[index] = 0
        if full[index]:
            continue
        strong = levels[index] == STRONG
        needed = 0
        if strong and _neighbours(index, shape, levels, WEAK) >= company:
            # Something new counts at once; a thing that is there already grows by evidence, or its edges would flicker.
            needed = edge_images if _grows(index, shape, levels, full) else 1
        elif strong or _neighbours(index, shape, levels, STRONG) > 0:
            needed = lone_images
        streak[index] = streak[index] + 1 if needed else 0
        if needed and streak[index] >= needed:
            full[index] = _NEW
            streak[index] = 0
        elif needed:
            waiting[waits] = index
            waits += 1
    for i in range(len(filled)):
        index = filled[i]
        if taken[index] == INSIDE:
            full[index] = 0
        elif levels[index] == 0 and through[i]:
            misses[index] += 1
            enough = misses[index] >= misses_beside
            if enough or (misses[index] >= misses_to_clear and _neighbours(index, shape, levels, STRONG) == 0):
                full[index] = 0
                misses[index] = 0
    for i in range(hits):
        levels[hit[i]] = 0
        full[hit[i]] = min(full[hit[i]], 1)
    return waits


@compiled()
def stamp_balls(balls: Array, near: float, corner: Array, voxel: float, shape: Counts, taken: Bytes) -> None:
    """Mark the voxels whose centres are in balls (k, 4), or nearer than `near` to them.

    The balls extend beyond the arm that they cover: voxels filled earlier inside them are hidden, not cleared.
    """
    for b in range(len(balls)):
        radius = balls[b, 3]
        reach = radius + near
        low0, high0 = _span(balls[b, 0] - corner[0], reach, voxel, shape[0])
        low1, high1 = _span(balls[b, 1] - corner[1], reach, voxel, shape[1])
        low2, high2 = _span(balls[b, 2] - corner[2], reach, voxel, shape[2])
        for i in range(low0, high0):
            x = corner[0] + (i + 0.5) * voxel - balls[b, 0]
            for j in range(low1, high1):
                y = corner[1] + (j + 0.5) * voxel - balls[b, 1]
                across = x * x + y * y
                if across > reach * reach:
                    continue
                row = (i * shape[1] + j) * shape[2]
                for k in range(low2, high2):
                    z = corner[2] + (k + 0.5) * voxel - balls[b, 2]
                    square = across + z * z
                    if square <= radius * radius:
                        taken[row + k] = max(taken[row + k], NEAR)
                    elif square <= reach * reach and taken[row + k] == FREE:
                        taken[row + k] = BESIDE


@compiled()
def _span(middle: float, reach: float, voxel: float, count: int) -> tuple[int, int]:
    """Return the first and last + 1 voxel along an axis that lie within `reach` of `middle`."""
    low = int(np.floor((middle - reach) / voxel))
    high = int(np.floor((middle + reach) / voxel)) + 1
    return min(max(low, 0), count), max(min(high, count), 0)


@compiled()
def unknown_voxels(full: Bytes, taken: Bytes, out: Bytes) -> None:
    """Write 1 for each full voxel free of known geometry; voxels near an arm that came later stay."""
    for i in range(len(full)):
        out[i] = full[i] if taken[i] <= BESIDE else 0

"""The basic functions of the compiled core: frames of the joints, distances, random numbers.

They take single numbers and few arrays: a call counts references to every array argument, which takes
as long as the work itself. Numba's cache detects changes of a function's own file only: after a change here
save `kernels` again.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.planning.scene.compiled_problem import (
    BALL,
    BOX,
    CAPSULE,
    CYLINDER,
    KIND,
    PLACE,
    PLANES,
    SIZE,
    SPHERE,
    TURN,
    Indices,
)
from robots.port import Array


@compiled()
def joint_frames(placements: Array, sliding: NDArray[np.bool_], q: Array, frames: Array) -> None:
    """Write the frames of the world (0), of each moved joint (1 … n) and of the tool (n + 1), 12 numbers each."""
    r0, r1, r2, r3, r4, r5, r6, r7, r8 = 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0
    px, py, pz = 0.0, 0.0, 0.0
    n = len(q)
    for i in range(n + 2):
        # The frame is kept in scalars: reading it back from the array would take twice the time.
        frames[i, 0], frames[i, 1], frames[i, 2] = r0, r1, r2
        frames[i, 3], frames[i, 4], frames[i, 5] = r3, r4, r5
        frames[i, 6], frames[i, 7], frames[i, 8] = r6, r7, r8
        frames[i, 9], frames[i, 10], frames[i, 11] = px, py, pz
        if i > n:
            break
        m0, m1, m2 = placements[i, 0], placements[i, 1], placements[i, 2]
        m3, m4, m5 = placements[i, 3], placements[i, 4], placements[i, 5]
        m6, m7, m8 = placements[i, 6], placements[i, 7], placements[i, 8]
        mx, my, mz = placements[i, 9], placements[i, 10], placements[i, 11]
        px, py, pz = (
            px + r0 * mx + r1 * my + r2 * mz,
            py + r3 * mx + r4 * my + r5 * mz,
            pz + r6 * mx + r7 * my + r8 * mz,
        )
        a0, a1, a2 = r0 * m0 + r1 * m3 + r2 * m6, r0 * m1 + r1 * m4 + r2 * m7, r0 * m2 + r1 * m5 + r2 * m8
        a3, a4, a5 = r3 * m0 + r4 * m3 + r5 * m6, r3 * m1 + r4 * m4 + r5 * m7, r3 * m2 + r4 * m5 + r5 * m8
        a6, a7, a8 = r6 * m0 + r7 * m3 + r8 * m6, r6 * m1 + r7 * m4 + r8 * m7, r6 * m2 + r7 * m5 + r8 * m8
        cosine, sine = 1.0, 0.0
        if i < n:
            if sliding[i]:
                px, py, pz = px + a2 * q[i], py + a5 * q[i], pz + a8 * q[i]
            else:
                cosine, sine = math.cos(q[i]), math.sin(q[i])
        r0, r1, r2 = cosine * a0 + sine * a1, cosine * a1 - sine * a0, a2
        r3, r4, r5 = cosine * a3 + sine * a4, cosine * a4 - sine * a3, a5
        r6, r7, r8 = cosine * a6 + sine * a7, cosine * a7 - sine * a6, a8


@compiled()
def place(frames: Array, joint: int, points: Array, first: int, last: int, out: Array) -> None:
    """Write the world positions of points of a joint's frame, rows `first` … `last` - 1."""
    f0, f1, f2 = frames[joint, 0], frames[joint, 1], frames[joint, 2]
    f3, f4, f5 = frames[joint, 3], frames[joint, 4], frames[joint, 5]
    f6, f7, f8 = frames[joint, 6], frames[joint, 7], frames[joint, 8]
    px, py, pz = frames[joint, 9], frames[joint, 10], frames[joint, 11]
    for i in range(first, last):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        out[i, 0] = f0 * x + f1 * y + f2 * z + px
        out[i, 1] = f3 * x + f4 * y + f5 * z + py
        out[i, 2] = f6 * x + f7 * y + f8 * z + pz


@compiled()
def place_balls(frames: Array, joints: Indices, balls: Array, out: Array) -> None:
    """Write the world positions of the links' bounding spheres (center, radius)."""
    for link in range(len(joints)):
        f = joints[link]
        x, y, z = balls[link, 0], balls[link, 1], balls[link, 2]
        out[link, 0] = frames[f, 0] * x + frames[f, 1] * y + frames[f, 2] * z + frames[f, 9]
        out[link, 1] = frames[f, 3] * x + frames[f, 4] * y + frames[f, 5] * z + frames[f, 10]
        out[link, 2] = frames[f, 6] * x + frames[f, 7] * y + frames[f, 8] * z + frames[f, 11]


@compiled()
def near_pairs(balls: Array, joints: Indices, solids: Array, gaps: Array, found: Indices) -> int:
    """Write the links and solids whose bounding spheres are nearer than the gap of their pair; return their number."""
    count = 0
    solid_count = len(solids)
    for link in range(len(joints)):
        if joints[link] == 0:
            continue
        x, y, z, radius = balls[link, 0], balls[link, 1], balls[link, 2], balls[link, 3]
        for k in range(solid_count):
            dx, dy, dz = x - solids[k, BALL], y - solids[k, BALL + 1], z - solids[k, BALL + 2]
            both = radius + gaps[link, k] + solids[k, BALL + 3]
            if both > 0.0 and dx * dx + dy * dy + dz * dz < both * both:
                found[count] = link * solid_count + k
                count += 1
    return count


@compiled()
def distance(solids: Array, planes: Array, k: int, wx: float, wy: float, wz: float) -> float:
    """Return the distance of a point from a solid, negative inside; for a hull, the largest distance to its planes."""
    x, y, z = wx - solids[k, PLACE], wy - solids[k, PLACE + 1], wz - solids[k, PLACE + 2]
    kind = int(solids[k, KIND])
    radius, half = solids[k, SIZE], solids[k, SIZE + 1]
    if kind == SPHERE:
        return math.sqrt(x * x + y * y + z * z) - radius
    x, y, z = (
        solids[k, TURN] * x + solids[k, TURN + 3] * y + solids[k, TURN + 6] * z,
        solids[k, TURN + 1] * x + solids[k, TURN + 4] * y + solids[k, TURN + 7] * z,
        solids[k, TURN + 2] * x + solids[k, TURN + 5] * y + solids[k, TURN + 8] * z,
    )
    if kind == BOX:
        dx, dy, dz = abs(x) - radius, abs(y) - half, abs(z) - solids[k, SIZE + 2]
        deepest = max(dx, dy, dz)
        if deepest <= 0.0:
            return deepest
        dx, dy, dz = max(dx, 0.0), max(dy, 0.0), max(dz, 0.0)
        return math.sqrt(dx * dx + dy * dy + dz * dz)
    if kind == CAPSULE:
        z -= min(max(z, -half), half)
        return math.sqrt(x * x + y * y + z * z) - radius
    if kind == CYLINDER:
        side, end = math.sqrt(x * x + y * y) - radius, abs(z) - half
        if max(side, end) <= 0.0:
            return max(side, end)
        side, end = max(side, 0.0), max(end, 0.0)
        return math.sqrt(side * side + end * end)
    farthest = -1e9
    for i in range(int(solids[k, PLANES]), int(solids[k, PLANES + 1])):
        farthest = max(farthest, planes[i, 0] * x + planes[i, 1] * y + planes[i, 2] * z + planes[i, 3])
    return farthest


@compiled()
def is_box_nearer(points: Array, radii: Array, first: int, last: int, solids: Array, k: int, reach: float) -> bool:
    """Return whether any of the spheres `first` … `last` - 1 is nearer than `reach` to a box."""
    t0, t1, t2 = solids[k, TURN], solids[k, TURN + 1], solids[k, TURN + 2]
    t3, t4, t5 = solids[k, TURN + 3], solids[k, TURN + 4], solids[k, TURN + 5]
    t6, t7, t8 = solids[k, TURN + 6], solids[k, TURN + 7], solids[k, TURN + 8]
    cx, cy, cz = solids[k, PLACE], solids[k, PLACE + 1], solids[k, PLACE + 2]
    hx, hy, hz = solids[k, SIZE], solids[k, SIZE + 1], solids[k, SIZE + 2]
    for i in range(first, last):
        limit = reach + radii[i, 3]
        x, y, z = points[i, 0] - cx, points[i, 1] - cy, points[i, 2] - cz
        dx = max(abs(t0 * x + t3 * y + t6 * z) - hx, 0.0)
        dy = max(abs(t1 * x + t4 * y + t7 * z) - hy, 0.0)
        dz = max(abs(t2 * x + t5 * y + t8 * z) - hz, 0.0)
        if limit > 0.0 and dx * dx + dy * dy + dz * dz < limit * limit:
            return True
    return False


@compiled()
def solid_gap(
    centres: Array, spheres: Array, first: int, last: int, solids: Array, planes: Array, k: int, enough: float
) -> float:
    """Return the smallest distance of spheres from a solid, at most `enough`."""
    gap = enough
    for i in range(first, last):
        x, y, z, radius = centres[i, 0], centres[i, 1], centres[i, 2], spheres[i, 3]
        dx, dy, dz = x - solids[k, BALL], y - solids[k, BALL + 1], z - solids[k, BALL + 2]
        both = gap + radius + solids[k, BALL + 3]
        if both > 0.0 and dx * dx + dy * dy + dz * dz < both * both:
            gap = min(gap, distance(solids, planes, k, x, y, z) - radius)
    return gap


@compiled()
def pair_gap(
    centres: Array, spheres: Array, balls: Array, a: int, a0: int, a1: int, b: int, b0: int, b1: int,
    near: Indices, enough: float, any_: bool,
) -> float:  # fmt: skip
    """Return the smallest distance of the spheres of two links, at most `enough`; any smaller one if `any_`.

    Spheres a0 … a1 - 1 are in bounding sphere `a` (center, radius), b0 … b1 - 1 in bounding sphere `b`.
    """
    gap = enough
    count = 0
    for j in range(b0, b1):
        dx, dy, dz = centres[j, 0] - balls[a, 0], centres[j, 1] - balls[a, 1], centres[j, 2] - balls[a, 2]
        reach = gap + spheres[j, 3] + balls[a, 3]
        if reach > 0.0 and dx * dx + dy * dy + dz * dz < reach * reach:
            near[count] = j
            count += 1
    if count == 0:
        return gap
    for i in range(a0, a1):
        x, y, z, radius = centres[i, 0], centres[i, 1], centres[i, 2], spheres[i, 3]
        dx, dy, dz = x - balls[b, 0], y - balls[b, 1], z - balls[b, 2]
        reach = gap + radius + balls[b, 3]
        if reach <= 0.0 or dx * dx + dy * dy + dz * dz >= reach * reach:
            continue
        for c in range(count):
            j = near[c]
            dx, dy, dz = x - centres[j, 0], y - centres[j, 1], z - centres[j, 2]
            reach = gap + radius + spheres[j, 3]
            square = dx * dx + dy * dy + dz * dz
            if reach > 0.0 and square < reach * reach:
                gap = math.sqrt(square) - radius - spheres[j, 3]
                if any_:
                    return gap
    return gap


@compiled()
def orientation_error(tool: Array, upright: Array, tilt: bool, error: Array) -> float:
    """Write the rotation (world axes) from the tool to its required orientation, and return its angle.

    `tool` has the 12 numbers of a frame; `upright` as in `CompiledProblem`.
    """
    ex, ey, ez, cosine = 0.0, 0.0, 0.0, 0.0
    for c in range(2 if tilt else 0, 3):
        if tilt:
            a0, a1, a2 = upright[3, 0], upright[3, 1], upright[3, 2]
        else:
            a0, a1, a2 = 1.0 if c == 0 else 0.0, 1.0 if c == 1 else 0.0, 1.0 if c == 2 else 0.0
        x = tool[0] * a0 + tool[1] * a1 + tool[2] * a2
        y = tool[3] * a0 + tool[4] * a1 + tool[5] * a2
        z = tool[6] * a0 + tool[7] * a1 + tool[8] * a2
        u, v, w = upright[0, c], upright[1, c], upright[2, c]
        ex, ey, ez = ex + y * w - z * v, ey + z * u - x * w, ez + x * v - y * u
        cosine += x * u + y * v + z * w
    if not tilt:
        ex, ey, ez, cosine = 0.5 * ex, 0.5 * ey, 0.5 * ez, 0.5 * (cosine - 1.0)
    sine = math.sqrt(ex * ex + ey * ey + ez * ez)
    angle = math.atan2(sine, cosine)
    scale = angle / sine if sine > 1e-12 else 0.0
    error[0], error[1], error[2] = ex * scale, ey * scale, ez * scale
    return angle


@compiled()
def random_number(state: NDArray[np.uint64]) -> float:
    """Return the next number in [0, 1) (splitmix64)."""
    state[0] = state[0] + np.uint64(0x9E3779B97F4A7C15)
    z = state[0]
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z = z ^ (z >> np.uint64(31))
    return float(z >> np.uint64(11)) / 9007199254740992.0


@compiled()
def nearest(nodes: Array, tree: int, count: int, q: Array) -> int:
    """Return the index of the node nearest to `q` among the first `count` nodes of a tree."""
    best, least = 0, 1e300
    for i in range(count):
        away = 0.0
        for j in range(len(q)):
            away += (nodes[tree, i, j] - q[j]) ** 2
        if away < least:
            best, least = i, away
    return best


@compiled()
def length(a: Array, b: Array) -> float:
    """Return the distance of two configurations."""
    total = 0.0
    for j in range(len(a)):
        total += (a[j] - b[j]) ** 2
    return math.sqrt(total)

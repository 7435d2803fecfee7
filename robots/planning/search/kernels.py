"""The compiled core of the fast planner: checks of configurations and paths.

An arm is links of spheres, the rest of the world convex solids and voxels; see `compiled_problem` for the arrays. A
configuration is blocked if a sphere is nearer to a solid than the gap of that link and solid, if two links are
nearer than the gap of that pair, or if the tool exceeds its orientation tolerance. After a change
here save `tree_kernels` again: numba's cache detects changes of a function's own file only.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.planning.scene.compiled_problem import BOX, FREE, GRID, KIND, TILT, CompiledProblem
from robots.planning.scene.voxel_distance_kernels import is_ball_far, is_voxel_nearer, voxel_gap
from robots.planning.search.geometry_kernels import (
    is_box_nearer,
    joint_frames,
    near_pairs,
    orientation_error,
    pair_gap,
    place,
    place_balls,
    solid_gap,
)
from robots.port import Array

Counts = NDArray[np.int64]
Flags = NDArray[np.bool_]


class Scratch(NamedTuple):
    """Working memory of a check; one per external call, as threads may call concurrently."""

    q: Array
    frames: Array
    balls: Array
    centres: Array
    placed: Flags
    near: Counts
    touching: Counts
    error: Array
    tries: Counts


@compiled()
def new_scratch(p: CompiledProblem) -> Scratch:
    """Return working memory for the checks of a problem."""
    n, links = len(p.sliding), len(p.link_joint)
    balls = np.empty((links, 4))
    balls[:, 3] = p.link_ball[:, 3]
    return Scratch(
        np.empty(n),
        np.empty((n + 2, 12)),
        balls,
        np.empty((len(p.spheres), 3)),
        np.empty(links, dtype=np.bool_),
        np.empty(len(p.spheres), dtype=np.int64),
        np.empty(p.solid_gap.size, dtype=np.int64),
        np.empty(3),
        np.zeros(1, dtype=np.int64),
    )


@compiled()
def _place_balls(p: CompiledProblem, q: Array, s: Scratch) -> None:
    joint_frames(p.placements, p.sliding, q, s.frames)
    for link in range(len(p.link_joint)):
        s.placed[link] = False
    place_balls(s.frames, p.link_joint, p.link_ball, s.balls)


@compiled()
def _place_link(p: CompiledProblem, link: int, s: Scratch) -> None:
    """Write the positions of a link's spheres, once per configuration."""
    if not s.placed[link]:
        s.placed[link] = True
        place(s.frames, p.link_joint[link], p.spheres, p.first_sphere[link], p.first_sphere[link + 1], s.centres)


@compiled()
def _pair_gap(p: CompiledProblem, a: int, b: int, enough: float, any_: bool, s: Scratch) -> float:
    _place_link(p, a, s)
    _place_link(p, b, s)
    a0, a1, b0, b1 = p.first_sphere[a], p.first_sphere[a + 1], p.first_sphere[b], p.first_sphere[b + 1]
    return pair_gap(s.centres, p.spheres, s.balls, a, a0, a1, b, b0, b1, s.near, enough, any_)


@compiled()
def _solid_gap(p: CompiledProblem, link: int, k: int, enough: float, s: Scratch) -> float:
    _place_link(p, link, s)
    first, last = p.first_sphere[link], p.first_sphere[link + 1]
    if p.solids[k, KIND] == GRID:
        return voxel_gap(s.centres, p.spheres, first, last, p.voxels, p.voxel_grid, enough)
    return solid_gap(s.centres, p.spheres, first, last, p.solids, p.planes, k, enough)


@compiled()
def _balls_near(s: Scratch, a: int, b: int, limit: float) -> bool:
    dx, dy, dz = s.balls[a, 0] - s.balls[b, 0], s.balls[a, 1] - s.balls[b, 1], s.balls[a, 2] - s.balls[b, 2]
    reach = s.balls[a, 3] + s.balls[b, 3] + limit
    return reach > 0.0 and dx * dx + dy * dy + dz * dz < reach * reach


@compiled()
def tilt_angle(p: CompiledProblem, s: Scratch) -> float:
    """Return the angle between the tool, at the current frames, and the orientation that it must keep."""
    return orientation_error(s.frames[len(s.frames) - 1], p.upright, p.orientation == TILT, s.error)


@compiled()
def _is_blocked(p: CompiledProblem, q: Array, s: Scratch) -> bool:
    return not is_edge_free(p, q, q, s)


@compiled()
def is_edge_free(p: CompiledProblem, a: Array, b: Array, s: Scratch) -> bool:
    """Return whether the straight line without `a` is free; checks the end first, then halves, then quarters.

    All checks are in this one function, as a call that passes a whole problem takes as long as a check.
    """
    frames, balls, centres, placed, touching, near = s.frames, s.balls, s.centres, s.placed, s.touching, s.near
    link_joint, first_sphere, spheres, solids, gaps = p.link_joint, p.first_sphere, p.spheres, p.solids, p.solid_gap
    voxels, grid, solid_count, q = p.voxels, p.voxel_grid, len(solids), s.q
    distance = 0.0
    for j in range(len(a)):
        distance += abs(b[j] - a[j]) * p.bound[j]
    count = max(1, math.ceil(distance / p.step_m))
    stride = 1
    while stride < count:
        stride *= 2
    i = count
    while True:
        s.tries[0] += 1
        for j in range(len(a)):
            q[j] = a[j] + (b[j] - a[j]) * (i / count)
        joint_frames(p.placements, p.sliding, q, frames)
        place_balls(frames, link_joint, p.link_ball, balls)
        placed[:] = False
        if p.orientation != FREE and tilt_angle(p, s) > p.tolerance:
            return False
        for t in range(near_pairs(balls, link_joint, solids, gaps, touching)):
            link, k = int(touching[t]) // solid_count, int(touching[t]) % solid_count
            limit, first, last = gaps[link, k], first_sphere[link], first_sphere[link + 1]
            box, seen = solids[k, KIND] == BOX, solids[k, KIND] == GRID
            if box and not is_box_nearer(balls, balls, link, link + 1, solids, k, limit):
                continue
            if seen and is_ball_far(balls, link, voxels, grid, limit):
                continue
            if not placed[link]:
                placed[link] = True
                place(frames, link_joint[link], spheres, first, last, centres)
            if box:
                if is_box_nearer(centres, spheres, first, last, solids, k, limit):
                    return False
            elif seen:
                if is_voxel_nearer(centres, spheres, first, last, voxels, grid, limit):
                    return False
            elif solid_gap(centres, spheres, first, last, solids, p.planes, k, limit) < limit:
                return False
        for t in range(len(p.pairs)):
            one, two, limit = int(p.pairs[t, 0]), int(p.pairs[t, 1]), p.pair_gap[t]
            dx, dy, dz = balls[one, 0] - balls[two, 0], balls[one, 1] - balls[two, 1], balls[one, 2] - balls[two, 2]
            reach = balls[one, 3] + balls[two, 3] + limit
            if reach <= 0.0 or dx * dx + dy * dy + dz * dz >= reach * reach:
                continue
            a0, a1, b0, b1 = first_sphere[one], first_sphere[one + 1], first_sphere[two], first_sphere[two + 1]
            if not placed[one]:
                placed[one] = True
                place(frames, link_joint[one], spheres, a0, a1, centres)
            if not placed[two]:
                placed[two] = True
                place(frames, link_joint[two], spheres, b0, b1, centres)
            if pair_gap(centres, spheres, balls, one, a0, a1, two, b0, b1, near, limit, True) < limit:
                return False
        # The next one: stride / 2, 3 stride / 2, … then with half the stride.
        i = stride // 2 if i == count else i + stride
        while i >= count and stride > 1:
            stride //= 2
            i = stride // 2
        if stride <= 1:
            return True


@compiled()
def blocked_at(p: CompiledProblem, path: Array) -> int:
    """Return the first blocked waypoint or segment (k for the segment that ends at waypoint k), -1 if all are free."""
    s = new_scratch(p)
    if len(path) and _is_blocked(p, path[0], s):
        return 0
    for k in range(1, len(path)):
        if not is_edge_free(p, path[k - 1], path[k], s):
            return k
    return -1


@compiled()
def check_along_path(p: CompiledProblem, rows: Array, looked: Counts, blocked: Flags) -> int:
    """Check rows of a path (k, n): the first, the last and enough that no point moves farther than the step between.

    Write the checked rows and whether each is blocked; return their number. Where two rows are farther apart
    than a step, the motion between them is checked as well and counts as the latter row.
    """
    s = new_scratch(p)
    count, at = 0, 0
    for k in range(len(rows)):
        distance = ahead = 0.0
        for j in range(rows.shape[1]):
            distance += abs(rows[k, j] - rows[at, j]) * p.bound[j]
            if k + 1 < len(rows):
                ahead += abs(rows[k + 1, j] - rows[at, j]) * p.bound[j]
        if k == 0 or k == len(rows) - 1 or ahead > p.step_m:
            looked[count] = k
            far = distance > p.step_m
            blocked[count] = not is_edge_free(p, rows[at] if far else rows[k], rows[k], s)
            count += 1
            at = k
    return count


@compiled()
def gaps(p: CompiledProblem, q: Array, to_solids: Array, between: Array) -> float:
    """Write the distances of each link from each solid (links, solids) and of each pair; return the tool's angle."""
    s = new_scratch(p)
    _place_balls(p, q, s)
    for link in range(len(p.link_joint)):
        for k in range(len(p.solids)):
            to_solids[link, k] = _solid_gap(p, link, k, 1e9, s)
    for i in range(len(p.pairs)):
        between[i] = _pair_gap(p, p.pairs[i, 0], p.pairs[i, 1], 1e9, False, s)
    return tilt_angle(p, s) if p.orientation != FREE else 0.0


@compiled()
def tool_rotation(p: CompiledProblem, q: Array) -> Array:
    """Return the rotation matrix (3, 3) of the tool link in the world."""
    frames = np.empty((len(q) + 2, 12))
    joint_frames(p.placements, p.sliding, q, frames)
    return frames[len(q) + 1, :9].copy().reshape(3, 3)


@compiled()
def path_cost(p: CompiledProblem, path: Array, keep_m: float, out: Array) -> None:
    """Write for each inner waypoint of a path, (waypoints + 2, n), the penetration depth of the spheres, meters.

    Distances to solids below `keep_m` count as well.
    """
    s = new_scratch(p)
    for w in range(1, len(path) - 1):
        _place_balls(p, path[w], s)
        deep = 0.0
        for link in range(len(p.link_joint)):
            for k in range(len(p.solids)) if p.link_joint[link] > 0 else range(0):
                limit = p.solid_gap[link, k] + keep_m
                if limit > -1e9:
                    deep += limit - _solid_gap(p, link, k, limit, s)
        for i in range(len(p.pairs)):
            a, b, limit = p.pairs[i, 0], p.pairs[i, 1], p.pair_gap[i]
            if _balls_near(s, a, b, limit):
                deep += limit - _pair_gap(p, a, b, limit, False, s)
        out[w - 1] = deep

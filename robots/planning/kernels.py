"""The compiled core of the fast planner: configuration and edge checks, RRT-Connect, shortcutting.

An arm is links of spheres, and the rest of the world convex solids; see `problem` for the arrays. A
configuration is blocked where a sphere comes nearer to a solid than the slack of that link and solid
allows, two links nearer than the slack of that pair, or the tool turns out of its tolerance.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.planning.leaf_kernels import (
    is_box_nearer,
    joint_frames,
    length,
    near_pairs,
    nearest,
    pair_gap,
    place,
    place_balls,
    random_number,
    solid_gap,
    turn_missing,
)
from robots.planning.problem import BOX, FREE, KIND, TILT, Problem
from robots.port import Array

Counts = NDArray[np.int64]
Flags = NDArray[np.bool_]


class _Scratch(NamedTuple):
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
def _scratch(p: Problem) -> _Scratch:
    n, links = len(p.sliding), len(p.link_joint)
    balls = np.empty((links, 4))
    balls[:, 3] = p.link_ball[:, 3]
    return _Scratch(
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
def _place_balls(p: Problem, q: Array, s: _Scratch) -> None:
    joint_frames(p.placements, p.sliding, q, s.frames)
    for link in range(len(p.link_joint)):
        s.placed[link] = False
    place_balls(s.frames, p.link_joint, p.link_ball, s.balls)


@compiled()
def _place_link(p: Problem, link: int, s: _Scratch) -> None:
    """Write where the spheres of a link are, once in each configuration."""
    if not s.placed[link]:
        s.placed[link] = True
        place(s.frames, p.link_joint[link], p.spheres, p.first_sphere[link], p.first_sphere[link + 1], s.centres)


@compiled()
def _pair_gap(p: Problem, a: int, b: int, enough: float, any_: bool, s: _Scratch) -> float:
    _place_link(p, a, s)
    _place_link(p, b, s)
    a0, a1, b0, b1 = p.first_sphere[a], p.first_sphere[a + 1], p.first_sphere[b], p.first_sphere[b + 1]
    return pair_gap(s.centres, p.spheres, s.balls, a, a0, a1, b, b0, b1, s.near, enough, any_)


@compiled()
def _solid_gap(p: Problem, link: int, k: int, enough: float, s: _Scratch) -> float:
    _place_link(p, link, s)
    first, last = p.first_sphere[link], p.first_sphere[link + 1]
    return solid_gap(s.centres, p.spheres, first, last, p.solids, p.planes, k, enough)


@compiled()
def _balls_near(s: _Scratch, a: int, b: int, limit: float) -> bool:
    dx, dy, dz = s.balls[a, 0] - s.balls[b, 0], s.balls[a, 1] - s.balls[b, 1], s.balls[a, 2] - s.balls[b, 2]
    reach = s.balls[a, 3] + s.balls[b, 3] + limit
    return reach > 0.0 and dx * dx + dy * dy + dz * dz < reach * reach


@compiled()
def _turned(p: Problem, s: _Scratch) -> float:
    return turn_missing(s.frames[len(s.frames) - 1], p.upright, p.orientation == TILT, s.error)


@compiled()
def _is_blocked(p: Problem, q: Array, s: _Scratch) -> bool:
    return not _is_edge_free(p, q, q, s)


@compiled()
def _is_edge_free(p: Problem, a: Array, b: Array, s: _Scratch) -> bool:
    """Return whether all but `a` of the straight line is free: the end first, then halves, quarters, …

    All checks are in this one function, as a call with a whole problem takes as long as a check.
    """
    frames, balls, centres, placed, touching, near = s.frames, s.balls, s.centres, s.placed, s.touching, s.near
    link_joint, first_sphere, spheres, solids, gaps = p.link_joint, p.first_sphere, p.spheres, p.solids, p.solid_gap
    solid_count, q = len(solids), s.q
    way = 0.0
    for j in range(len(a)):
        way += abs(b[j] - a[j]) * p.bound[j]
    count = max(1, math.ceil(way / p.step_m))
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
        if p.orientation != FREE and _turned(p, s) > p.tolerance:
            return False
        for t in range(near_pairs(balls, link_joint, solids, gaps, touching)):
            link, k = int(touching[t]) // solid_count, int(touching[t]) % solid_count
            limit, first, last = gaps[link, k], first_sphere[link], first_sphere[link + 1]
            box = solids[k, KIND] == BOX
            if box and not is_box_nearer(balls, balls, link, link + 1, solids, k, limit):
                continue
            if not placed[link]:
                placed[link] = True
                place(frames, link_joint[link], spheres, first, last, centres)
            if box:
                if is_box_nearer(centres, spheres, first, last, solids, k, limit):
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
def _project(p: Problem, q: Array, s: _Scratch) -> bool:
    """Turn the tool back to how it shall stand, by Newton steps; False where that does not succeed."""
    n = len(q)
    a = np.empty((3, 3))
    for _ in range(12):
        joint_frames(p.placements, p.sliding, q, s.frames)
        if _turned(p, s) < 0.2 * p.tolerance:
            return True
        # J of the turn, without the part about the upright axis where that is free; y = (J Jᵀ + λ)⁻¹ error.
        a[:, :] = 0.0
        a[0, 0] = a[1, 1] = a[2, 2] = 1e-4
        for j in range(n):
            if not p.sliding[j]:
                z = _turn_of(p, s, j)
                for r in range(3):
                    for c in range(3):
                        a[r, c] += z[r] * z[c]
        y = np.linalg.solve(a, s.error)
        for j in range(n):
            if not p.sliding[j]:
                z = _turn_of(p, s, j)
                step = z[0] * y[0] + z[1] * y[1] + z[2] * y[2]
                q[j] = min(max(q[j] + min(max(step, -0.5), 0.5), p.limits[0, j]), p.limits[1, j])
    return False


@compiled()
def _turn_of(p: Problem, s: _Scratch, j: int) -> tuple[float, float, float]:
    """Return how joint `j` turns the tool (world axes), without what is free."""
    x, y, z = s.frames[j + 1, 2], s.frames[j + 1, 5], s.frames[j + 1, 8]
    if p.orientation == TILT:
        u, v, w = p.upright[0, 2], p.upright[1, 2], p.upright[2, 2]
        along = x * u + y * v + z * w
        return x - along * u, y - along * v, z - along * w
    return x, y, z


@compiled()
def _advance(
    p: Problem,
    nodes: Array,
    parents: Counts,
    tree: int,
    count: int,
    target: Array,
    stride: float,
    steps: int,
    s: _Scratch,
) -> tuple[int, int, bool]:
    """Grow a tree from its node nearest to `target` towards it; return its size, the last node, whether it is there."""
    n = len(target)
    at = nearest(nodes, tree, count, target)
    away = length(nodes[tree, at], target)
    new = np.empty(n)
    for _ in range(steps):
        if count == nodes.shape[1]:
            break
        share = 1.0 if away <= stride else stride / away
        for j in range(n):
            new[j] = nodes[tree, at, j] + share * (target[j] - nodes[tree, at, j])
        if p.orientation != FREE and share < 1.0 and not _project(p, new, s):
            break
        left = length(new, target)
        if left > away - 0.2 * min(stride, away) or not _is_edge_free(p, nodes[tree, at], new, s):
            break
        nodes[tree, count, :] = new
        parents[tree, count] = at
        at, away = count, left
        count += 1
        if share >= 1.0:
            return count, at, True
    return count, at, False


@compiled()
def grow(
    p: Problem,
    nodes: Array,
    parents: Counts,
    counts: Counts,
    state: NDArray[np.uint64],
    stride: float,
    rounds: int,
    met: Counts,
) -> bool:
    """Let two trees grow for some rounds, RRT-Connect; True when they have met, at the nodes in `met`.

    `nodes` (2, size, n), `parents` (2, size) and `counts` (2) hold the trees, which begin at the starts
    and at the goals; `state` is of the random numbers. `counts` has a
    third number, the configurations looked at.
    """
    s = _scratch(p)
    n = len(p.sliding)
    sample = np.empty(n)
    for _ in range(rounds):
        if max(counts[0], counts[1]) >= nodes.shape[1]:
            break
        one = 0 if counts[0] <= counts[1] else 1
        other = 1 - one
        for j in range(n):
            sample[j] = p.limits[2, j] + (p.limits[3, j] - p.limits[2, j]) * random_number(state)
        if p.orientation != FREE and not _project(p, sample, s):
            continue
        before = counts[one]
        # Where the tool must stay upright the steps are short, and so a tree takes several at once.
        steps = 1 if p.orientation == FREE else 8
        counts[one], at, _ = _advance(p, nodes, parents, one, before, sample, stride, steps, s)
        if counts[one] == before:
            continue
        size = counts[other]
        counts[other], end, there = _advance(p, nodes, parents, other, size, nodes[one, at], stride, 10_000, s)
        if there:
            met[one], met[other] = at, end
            counts[2] += s.tries[0]
            return True
    counts[2] += s.tries[0]
    return False


@compiled()
def shorten(p: Problem, path: Array, state: NDArray[np.uint64], rounds: int, tries: Counts) -> Array:
    """Return a shorter free way with the same ends: waypoints left out, then random points joined directly."""
    s = _scratch(p)
    n = path.shape[1]
    out = np.empty((len(path) + rounds + 2, n))
    out[0] = path[0]
    count, i = 1, 0
    while i < len(path) - 1:
        j = len(path) - 1
        while j > i + 1 and not _is_edge_free(p, path[i], path[j], s):
            j -= 1
        out[count] = path[j]
        count += 1
        i = j
    along = np.empty(len(out))
    a, b = np.empty(n), np.empty(n)
    for _ in range(rounds):
        if count < 3:
            break
        along[0] = 0.0
        for k in range(1, count):
            along[k] = along[k - 1] + length(out[k], out[k - 1])
        first, second = random_number(state) * along[count - 1], random_number(state) * along[count - 1]
        first, second = min(first, second), max(first, second)
        i = j = 0
        while i < count - 2 and along[i + 1] <= first:
            i += 1
        while j < count - 2 and along[j + 1] <= second:
            j += 1
        if i == j:
            continue
        for k in range(n):
            a[k] = out[i, k] + (out[i + 1, k] - out[i, k]) * (first - along[i]) / (along[i + 1] - along[i])
            b[k] = out[j, k] + (out[j + 1, k] - out[j, k]) * (second - along[j]) / (along[j + 1] - along[j])
        if length(a, b) > 0.98 * (second - first) or not _is_edge_free(p, a, b, s):
            continue
        # Waypoints i + 1 … j give way to a and b.
        rest = out[j + 1 : count].copy()
        out[i + 1], out[i + 2] = a, b
        count = i + 3 + len(rest)
        out[i + 3 : count] = rest
    tries[0] += s.tries[0]
    return out[:count].copy()


@compiled()
def blocked_at(p: Problem, path: Array) -> int:
    """Return the first waypoint or segment (k for what leads to waypoint k) that is blocked, -1 when all is free."""
    s = _scratch(p)
    if len(path) and _is_blocked(p, path[0], s):
        return 0
    for k in range(1, len(path)):
        if not _is_edge_free(p, path[k - 1], path[k], s):
            return k
    return -1


@compiled()
def gaps(p: Problem, q: Array, to_solids: Array, between: Array) -> float:
    """Write the distances of each link from each solid (links, solids) and of each pair; return the tool's turn."""
    s = _scratch(p)
    _place_balls(p, q, s)
    for link in range(len(p.link_joint)):
        for k in range(len(p.solids)):
            to_solids[link, k] = _solid_gap(p, link, k, 1e9, s)
    for i in range(len(p.pairs)):
        between[i] = _pair_gap(p, p.pairs[i, 0], p.pairs[i, 1], 1e9, False, s)
    return _turned(p, s) if p.orientation != FREE else 0.0


@compiled()
def tool_rotation(p: Problem, q: Array) -> Array:
    """Return the rotation matrix (3, 3) of the tool link in the world."""
    frames = np.empty((len(q) + 2, 12))
    joint_frames(p.placements, p.sliding, q, frames)
    return frames[len(q) + 1, :9].copy().reshape(3, 3)


@compiled()
def path_cost(p: Problem, path: Array, keep_m: float, out: Array) -> None:
    """Write for each inner waypoint of a way, (waypoints + 2, n), how deep spheres are in what they touch, metres.

    Nearer to a solid than `keep_m` counts as well.
    """
    s = _scratch(p)
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

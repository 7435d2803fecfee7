"""The compiled searches of the fast planner: RRT-Connect, shortcuts, projection onto the orientation constraint."""

from __future__ import annotations

from importlib import import_module

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.planning.scene.compiled_problem import FREE, TILT, CompiledProblem
from robots.planning.search.geometry_kernels import joint_frames, length, nearest, random_number
from robots.planning.search.kernels import Counts, Scratch, is_edge_free, new_scratch, tilt_angle
from robots.port import Array

# `np.linalg.solve` uses it; otherwise the first search would load it while it runs.
import_module("scipy.linalg.cython_lapack")


@compiled()
def _project(p: CompiledProblem, q: Array, s: Scratch) -> bool:
    """Rotate the tool back to its required orientation by Newton steps; return False on failure."""
    n = len(q)
    a = np.empty((3, 3))
    for _ in range(12):
        joint_frames(p.placements, p.sliding, q, s.frames)
        if tilt_angle(p, s) < 0.2 * p.tolerance:
            return True
        # J of the rotation, without the part about the upright axis if that is free; y = (J Jᵀ + λ)⁻¹ error.
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
def _turn_of(p: CompiledProblem, s: Scratch, j: int) -> tuple[float, float, float]:
    """Return the rotation axis of joint `j` (world axes), without the free part."""
    x, y, z = s.frames[j + 1, 2], s.frames[j + 1, 5], s.frames[j + 1, 8]
    if p.orientation == TILT:
        u, v, w = p.upright[0, 2], p.upright[1, 2], p.upright[2, 2]
        along = x * u + y * v + z * w
        return x - along * u, y - along * v, z - along * w
    return x, y, z


@compiled()
def _advance(
    p: CompiledProblem,
    nodes: Array,
    parents: Counts,
    tree: int,
    count: int,
    target: Array,
    stride: float,
    steps: int,
    s: Scratch,
) -> tuple[int, int, bool]:
    """Grow a tree from its node nearest to `target` towards it; return its size, the last node, whether it arrived."""
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
        if left > away - 0.2 * min(stride, away) or not is_edge_free(p, nodes[tree, at], new, s):
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
    p: CompiledProblem,
    nodes: Array,
    parents: Counts,
    counts: Counts,
    state: NDArray[np.uint64],
    stride: float,
    rounds: int,
    met: Counts,
) -> bool:
    """Grow two trees for some rounds by RRT-Connect; return True when they have met, at the nodes in `met`.

    `nodes` (2, size, n), `parents` (2, size) and `counts` (2) hold the trees, rooted at the start and at the
    goals; `state` is that of the random numbers. The third number of `counts` is the configurations checked.
    """
    s = new_scratch(p)
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
        # With an orientation constraint the steps are short, so a tree takes several at once.
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
def shorten(p: CompiledProblem, path: Array, state: NDArray[np.uint64], rounds: int, tries: Counts) -> Array:
    """Return a shorter free path with the same endpoints: drops waypoints, then connects random points directly."""
    s = new_scratch(p)
    n = path.shape[1]
    out = np.empty((len(path) + rounds + 2, n))
    out[0] = path[0]
    count, i = 1, 0
    while i < len(path) - 1:
        j = len(path) - 1
        while j > i + 1 and not is_edge_free(p, path[i], path[j], s):
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
        if length(a, b) > 0.98 * (second - first) or not is_edge_free(p, a, b, s):
            continue
        # a and b replace waypoints i + 1 … j.
        rest = out[j + 1 : count].copy()
        out[i + 1], out[i + 2] = a, b
        count = i + 3 + len(rest)
        out[i + 3 : count] = rest
    tries[0] += s.tries[0]
    return out[:count].copy()

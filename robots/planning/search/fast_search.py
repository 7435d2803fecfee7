"""The fast planner: tries the straight line, then RRT-Connect in the compiled core, then shortcuts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from robots.planning.scene.compiled_problem import FREE, CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker, PathCollision
from robots.planning.search.kernels import blocked_at, check_along_path, gaps, path_cost, tool_rotation
from robots.planning.search.problem_compiler import ProblemNames
from robots.planning.search.search_task import SearchBudget, SearchTask
from robots.planning.search.tree_kernels import grow, shorten
from robots.port import Array

_NODES, _ROUNDS = 20_000, 64
_STRIDE_RAD, _UPRIGHT_STRIDE_RAD = 1.2, 0.3
_SHORTCUTS = 160
# Goals within this distance, by the joint with the longest motion, are searched first for this share of the time.
_NEAR_SHARE, _NEAR_RAD, _NEAR_TIME = 1.5, 0.3, 0.5
_SLACK_M = 1e-4
# Added to the distance of a pair's spheres at which the links themselves touched.
_LEARNT_M = 2e-3


def fast_search(task: SearchTask, budget: SearchBudget) -> Array | None:
    """Return a path that is free for the spheres, None when the budget is spent; see `SearchAlgorithm`.

    Goals are nearest first. Those much farther than the nearest are searched last: a straight line to the
    other side of the arm's reach is no better than a short path around an obstacle.
    """
    reach = np.abs(task.goals - task.start).max(axis=1)
    near_count = int(np.count_nonzero(reach <= _NEAR_SHARE * reach[0] + _NEAR_RAD))
    if near_count < len(task.goals):
        part = budget.part(_NEAR_TIME)
        path = _search_goals(replace(task, goals=task.goals[:near_count]), part)
        budget.spend(part.checks)
        if path is not None:
            return path
    return _search_goals(task, budget)


def _search_goals(task: SearchTask, budget: SearchBudget) -> Array | None:
    problem = with_sampling(task.problem, task.start, task.goals)
    for goal in task.goals:
        line = np.vstack((task.start, goal))
        budget.spend(1)
        if blocked_at(problem, line) < 0:
            return line
    return _rrt_connect(problem, task, budget)


def shorten_path(problem: CompiledProblem, path: Array, *, seed: int, budget: SearchBudget) -> Array:
    """Return a shorter path with the same endpoints that is free for the spheres, as `path` is."""
    if len(path) < 3:
        return path
    tries = np.zeros(1, dtype=np.int64)
    shorter = shorten(problem, np.ascontiguousarray(path), _random_state(seed), _SHORTCUTS, tries)
    budget.spend(int(tries[0]))
    return shorter


def with_sampling(problem: CompiledProblem, start: Array, goals: Array) -> CompiledProblem:
    """Return the problem in which samples of joints with over one turn of range stay within half a turn of the ends."""
    ends, lower, upper = np.vstack((start, goals)), problem.limits[0], problem.limits[1]
    wide = ~problem.sliding & (upper - lower > 2.0 * math.pi)
    low, high = lower.copy(), upper.copy()
    low[wide] = np.maximum(lower, ends.min(axis=0) - math.pi)[wide]
    high[wide] = np.minimum(upper, ends.max(axis=0) + math.pi)[wide]
    return problem._replace(limits=np.vstack((lower, upper, low, high)))


def with_room_for(problem: CompiledProblem, free: Array) -> CompiledProblem:
    """Return the problem in which these configurations (k, n), known to be free, are free for the spheres.

    Spheres extend beyond the arm, so an arm close to an object appears to touch. Pairs that appear to
    touch in a known configuration may come as near as there on the whole path; the exact check decides.
    """
    solid_gap, pair_gap = problem.solid_gap.copy(), problem.pair_gap.copy()
    to_solids, between = np.empty_like(solid_gap), np.empty_like(pair_gap)
    for joints in free:
        if blocked_at(problem, joints[None]) < 0:
            continue
        gaps(problem, joints, to_solids, between)
        np.minimum(solid_gap, to_solids - _SLACK_M, out=solid_gap, where=to_solids < solid_gap + _SLACK_M)
        np.minimum(pair_gap, between - _SLACK_M, out=pair_gap, where=between < pair_gap + _SLACK_M)
    return problem._replace(solid_gap=solid_gap, pair_gap=pair_gap)


def with_wider_gaps(problem: CompiledProblem, names: ProblemNames, hit: PathCollision) -> CompiledProblem:
    """Return the problem that keeps the pairs of a collision, which the spheres missed, farther apart."""
    solid_gap, pair_gap = problem.solid_gap.copy(), problem.pair_gap.copy()
    to_solids, between = np.empty_like(solid_gap), np.empty_like(pair_gap)
    gaps(problem, np.ascontiguousarray(hit.joints), to_solids, between)
    for touching in hit.pairs:
        pair = set(touching)
        for i, (a, b) in enumerate(problem.pairs):
            if {names.links[a], names.links[b]} == pair:
                pair_gap[i] = max(pair_gap[i], between[i] + _LEARNT_M)
        for link, solid in zip(*np.nonzero(np.isfinite(solid_gap)), strict=True):
            if {names.links[link], names.solids[solid]} == pair:
                solid_gap[link, solid] = max(solid_gap[link, solid], to_solids[link, solid] + _LEARNT_M)
    return problem._replace(solid_gap=solid_gap, pair_gap=pair_gap)


def tilt_at(problem: CompiledProblem, joints: Array) -> float:
    """Return the angle between the tool and the orientation that it must keep, at `joints` (n,)."""
    return float(gaps(problem, joints, np.empty_like(problem.solid_gap), np.empty_like(problem.pair_gap)))


def is_tilted(problem: CompiledProblem, joints: Array) -> bool:
    """Return whether the tool exceeds its orientation tolerance at `joints` (n,)."""
    return problem.orientation != FREE and tilt_at(problem, joints) > problem.tolerance


def count_exact_checks(checker: ExactChecker, path: Array) -> int:
    """Return the number of configurations in the exact check of a path."""
    return 1 + sum(checker.steps(path[i], path[i + 1]) for i in range(len(path) - 1))


def warm_up(problem: CompiledProblem) -> None:
    """Compile everything that a first request would wait for."""
    joints = problem.limits[:2].mean(axis=0)
    bent = np.vstack((joints, joints + 1e-3, joints))
    nodes, parents = np.stack((bent, bent)), np.zeros((2, 3), dtype=np.int64)
    counts, met = np.array([1, 1, 0]), np.zeros(2, dtype=np.int64)
    blocked_at(problem, bent)
    check_along_path(problem, bent, np.empty(3, dtype=np.int64), np.empty(3, dtype=np.bool_))
    tilt_at(problem, joints)
    tool_rotation(problem, joints)
    path_cost(problem, bent, 0.0, np.empty(1))
    shorten(problem, bent, _random_state(0), 1, np.zeros(1, dtype=np.int64))
    grow(problem, nodes, parents, counts, _random_state(0), _STRIDE_RAD, 1, met)


def _rrt_connect(problem: CompiledProblem, task: SearchTask, budget: SearchBudget) -> Array | None:
    roots = (task.start[None], task.goals)
    dof = len(task.start)
    nodes = np.empty((2, _NODES, dof))
    parents = np.empty((2, _NODES), dtype=np.int64)
    counts, met = np.zeros(3, dtype=np.int64), np.zeros(2, dtype=np.int64)
    for tree, root in enumerate(roots):
        nodes[tree, : len(root)] = root
        parents[tree, : len(root)] = -1
        counts[tree] = len(root)
    state = _random_state(task.seed)
    stride = _STRIDE_RAD if problem.orientation == FREE else _UPRIGHT_STRIDE_RAD
    while not budget.over and int(counts[:2].max()) < _NODES:
        before = int(counts[2])
        connected = grow(problem, nodes, parents, counts, state, stride, _ROUNDS, met)
        # A round that ends at once at a blocked sample counts too, so that every budget ends.
        budget.spend(int(counts[2]) - before + _ROUNDS)
        if connected:
            outward = _branch(nodes[0], parents[0], int(met[0]))[::-1]
            return np.array(outward + _branch(nodes[1], parents[1], int(met[1]))[1:])
    return None


def _branch(nodes: Array, parents: Array, end: int) -> list[Array]:
    branch: list[Array] = []
    at = end
    while at >= 0:
        branch.append(nodes[at])
        at = int(parents[at])
    return branch


def _random_state(seed: int) -> NDArray[np.uint64]:
    return np.array([(seed * 0x9E3779B97F4A7C15 + 0x632BE59BD9B4E019) % 2**64], dtype=np.uint64)

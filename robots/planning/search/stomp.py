"""STOMP: a straight line of waypoints is shaken, and what is cheaper is kept; smooth ways, found only nearby."""

from __future__ import annotations

import numpy as np

from robots.planning.search.fast_search import with_sampling
from robots.planning.search.kernels import blocked_at, path_cost
from robots.planning.search.search_task import SearchBudget, SearchTask
from robots.port import Array

_WAYPOINTS, _ROLLOUTS = 30, 12
_SPREAD_RAD, _LEAST_SPREAD_RAD, _COOLING = 0.6, 0.08, 0.97
_SENSITIVITY = 10.0
_KEEP_AWAY_M = 0.02


def stomp_search(task: SearchTask, budget: SearchBudget) -> Array | None:
    """Return a smooth way to the nearest goal that the spheres take for free, None when the budget is spent.

    As in Kalakrishnan et al., "STOMP: Stochastic Trajectory Optimization for Motion Planning" (2011), with
    the depth of the spheres in what they touch as cost. It only finds a way near the straight line.
    """
    problem = with_sampling(task.problem, task.start, task.goals)
    random = np.random.default_rng(task.seed)
    smoothing, factor = _smoothing(_WAYPOINTS)
    shares = np.arange(_WAYPOINTS + 2)[:, None] / (_WAYPOINTS + 1)
    line: Array = task.start + shares * (task.goals[0] - task.start)
    way: Array = line.copy()
    spread = _SPREAD_RAD
    checks = (_WAYPOINTS + 1) * (_ROLLOUTS + 1)
    while not budget.over:
        budget.spend(checks)
        if blocked_at(problem, way) < 0:
            return way
        costs = np.empty((_ROLLOUTS + 1, _WAYPOINTS))
        shaken: Array = np.repeat(way[None], _ROLLOUTS + 1, axis=0)
        noise = np.einsum("ij,rjn->rin", factor, random.standard_normal((_ROLLOUTS, _WAYPOINTS, way.shape[1])))
        shaken[1:, 1:-1] += spread * noise
        np.clip(shaken, problem.limits[0], problem.limits[1], out=shaken)
        for cost, rollout in zip(costs, shaken, strict=True):
            path_cost(problem, rollout, _KEEP_AWAY_M, cost)
        low, high = costs.min(axis=0), costs.max(axis=0)
        weights = np.exp(-_SENSITIVITY * (costs - low) / np.maximum(high - low, 1e-9))
        weights /= weights.sum(axis=0)
        step = np.einsum("rw,rwn->wn", weights, shaken[:, 1:-1] - way[1:-1])
        way[1:-1] = np.clip(way[1:-1] + smoothing @ step, problem.limits[0], problem.limits[1])
        spread = max(spread * _COOLING, _LEAST_SPREAD_RAD)
        if spread <= _LEAST_SPREAD_RAD:
            # Settled where it is not free: begin anew.
            way, spread = line.copy(), _SPREAD_RAD
    return None


def _smoothing(count: int) -> tuple[Array, Array]:
    """Return the matrix that smooths a change (count, count), and one that makes noise smooth, at most 1 large."""
    second = np.zeros((count + 2, count))
    for i in range(count):
        second[i : i + 3, i] = (1.0, -2.0, 1.0)
    inverse = np.linalg.inv(second.T @ second)
    factor = np.linalg.cholesky(inverse)
    factor /= np.sqrt(np.diag(inverse).max())
    return inverse / (count * inverse.max(axis=0)), factor

"""STOMP: optimizes a straight line of waypoints by noisy rollouts; finds smooth paths, but only near the line."""

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
    """Return a smooth path to the nearest goal that is free for the spheres, None when the budget is spent.

    As in Kalakrishnan et al., "STOMP: Stochastic Trajectory Optimization for Motion Planning" (2011), with
    the penetration depth of the spheres as cost. It only finds a path near the straight line.
    """
    problem = with_sampling(task.problem, task.start, task.goals)
    random = np.random.default_rng(task.seed)
    smoothing, factor = _smoothing(_WAYPOINTS)
    shares = np.arange(_WAYPOINTS + 2)[:, None] / (_WAYPOINTS + 1)
    line: Array = task.start + shares * (task.goals[0] - task.start)
    path: Array = line.copy()
    spread = _SPREAD_RAD
    checks = (_WAYPOINTS + 1) * (_ROLLOUTS + 1)
    while not budget.over:
        budget.spend(checks)
        if blocked_at(problem, path) < 0:
            return path
        costs = np.empty((_ROLLOUTS + 1, _WAYPOINTS))
        rollouts: Array = np.repeat(path[None], _ROLLOUTS + 1, axis=0)
        noise = np.einsum("ij,rjn->rin", factor, random.standard_normal((_ROLLOUTS, _WAYPOINTS, path.shape[1])))
        rollouts[1:, 1:-1] += spread * noise
        np.clip(rollouts, problem.limits[0], problem.limits[1], out=rollouts)
        for cost, rollout in zip(costs, rollouts, strict=True):
            path_cost(problem, rollout, _KEEP_AWAY_M, cost)
        low, high = costs.min(axis=0), costs.max(axis=0)
        weights = np.exp(-_SENSITIVITY * (costs - low) / np.maximum(high - low, 1e-9))
        weights /= weights.sum(axis=0)
        step = np.einsum("rw,rwn->wn", weights, rollouts[:, 1:-1] - path[1:-1])
        path[1:-1] = np.clip(path[1:-1] + smoothing @ step, problem.limits[0], problem.limits[1])
        spread = max(spread * _COOLING, _LEAST_SPREAD_RAD)
        if spread <= _LEAST_SPREAD_RAD:
            # Converged to a blocked path: restart.
            path, spread = line.copy(), _SPREAD_RAD
    return None


def _smoothing(count: int) -> tuple[Array, Array]:
    """Return the matrix that smooths an update (count, count), and the one that smooths noise, with entries up to 1."""
    second = np.zeros((count + 2, count))
    for i in range(count):
        second[i : i + 3, i] = (1.0, -2.0, 1.0)
    inverse = np.linalg.inv(second.T @ second)
    factor = np.linalg.cholesky(inverse)
    factor /= np.sqrt(np.diag(inverse).max())
    return inverse / (count * inverse.max(axis=0)), factor

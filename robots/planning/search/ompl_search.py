"""OMPL planners by name, with the exact checker: slower than the fast planner, exact where spheres are too large."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from robots.planning.scene.compiled_problem import FREE
from robots.planning.search.fast_search import tilt_at, with_sampling
from robots.planning.search.search_task import SearchAlgorithm, SearchBudget, SearchTask
from robots.port import Array

_THREADED = ("PRM", "PRMstar")
_RANGE_RAD = 1.0
_ENOUGH = 1e9


def ompl_search(name: str) -> SearchAlgorithm:
    """Return the planner of `OMPL_PLANNERS` with that name; optimizing planners stop at the first path.

    PRM and PRMstar use wall time and cannot be canceled.
    """

    def search(task: SearchTask, budget: SearchBudget) -> Array | None:
        return _solve(name, task, budget)

    return search


class _ValidityChecker:
    """Counts and executes the checks; OMPL passes states, which are read joint by joint."""

    def __init__(self, task: SearchTask, budget: SearchBudget) -> None:
        self._task = task
        self._budget = budget
        self._dof = len(task.start)
        self._upright = task.problem.orientation != FREE

    def is_free(self, state: Any) -> bool:
        self._budget.spend(1)
        return self._is_free(self.joints(state))

    def is_path_free(self, first: Any, second: Any) -> bool:
        start, end = self.joints(first), self.joints(second)
        count = self._task.checker.steps(start, end)
        self._budget.spend(count)
        if self._upright and not self._stays_upright(start, end, count):
            return False
        return self._task.checker.is_edge_free(start, end)

    def joints(self, state: Any) -> Array:
        return np.array([state[i] for i in range(self._dof)], dtype=np.float64)

    def _is_free(self, joints: Array) -> bool:
        if self._upright and tilt_at(self._task.problem, joints) > self._task.problem.tolerance:
            return False
        return not self._task.checker.in_collision(joints)

    def _stays_upright(self, start: Array, end: Array, count: int) -> bool:
        problem = self._task.problem
        return all(
            tilt_at(problem, start + (end - start) * (i / count)) <= problem.tolerance for i in range(1, count + 1)
        )


def _solve(name: str, task: SearchTask, budget: SearchBudget) -> Array | None:
    # OMPL loads slowly and has no stubs; it is imported only in this function.
    base: Any = import_module("ompl.base")
    geometric: Any = import_module("ompl.geometric")
    util: Any = import_module("ompl.util")
    util.setLogLevel(util.LOG_NONE)
    # With zero OMPL would choose a seed.
    util.RNG.setSeed(task.seed % 2**31 + 1)
    space = _space(base, task)
    setup = geometric.SimpleSetup(space)
    information = setup.getSpaceInformation()
    validity = _ValidityChecker(task, budget)
    setup.setStateValidityChecker(validity.is_free)
    motions = _motion_validator(base, information, validity)
    information.setMotionValidator(motions)
    goals = base.GoalStates(information)
    for joints in task.goals:
        goals.addState(_state(space, joints))
    setup.addStartState(_state(space, task.start))
    setup.setGoal(goals)
    objective = base.PathLengthOptimizationObjective(information)
    # Any path is enough: otherwise optimizing planners would use all of the time.
    objective.setCostThreshold(base.Cost(_ENOUGH))
    setup.setOptimizationObjective(objective)
    planner = getattr(geometric, name)(information)
    if hasattr(planner, "setRange"):
        planner.setRange(_RANGE_RAD)
    setup.setPlanner(planner)
    if name in _THREADED:
        # These evaluate the termination condition in a second OMPL thread, which would wait forever for the
        # interpreter lock.
        setup.solve(base.timedPlannerTerminationCondition(budget.left_s))
    else:
        setup.solve(base.PlannerTerminationCondition(lambda: budget.over))
    if not setup.haveExactSolutionPath():
        return None
    return np.array([validity.joints(state) for state in setup.getSolutionPath().getStates()])


def _space(base: Any, task: SearchTask) -> Any:
    problem = with_sampling(task.problem, task.start, task.goals)
    space = base.RealVectorStateSpace(len(task.start))
    bounds = base.RealVectorBounds(len(task.start))
    ends = np.vstack((task.start, task.goals))
    for i, (low, high) in enumerate(zip(problem.limits[2], problem.limits[3], strict=True)):
        # An endpoint may exceed a limit by the last digit.
        bounds.setLow(i, min(float(low), float(ends[:, i].min())))
        bounds.setHigh(i, max(float(high), float(ends[:, i].max())))
    space.setBounds(bounds)
    space.setLongestValidSegmentFraction(
        min(1.0, 0.05 / max(1e-6, float(np.linalg.norm(problem.limits[1] - problem.limits[0]))))
    )
    return space


def _state(space: Any, joints: Array) -> Any:
    state = space.allocState()
    for i, value in enumerate(joints.tolist()):
        state[i] = value
    return state


def _motion_validator(base: Any, information: Any, validity: _ValidityChecker) -> Any:
    class Motions(base.MotionValidator):
        def checkMotion(self, first: Any, second: Any, *_last: Any) -> bool:  # noqa: N802 - OMPL's name
            return validity.is_path_free(first, second)

    return Motions(information)

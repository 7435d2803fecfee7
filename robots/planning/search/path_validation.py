"""Validates a given path exactly, without changing it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from engine.errors import CellError
from robots.planning.request import PathGoal, PlanRefusal, PlanRequest
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.search.endpoints import Endpoints, describe_collision, outside_limits, with_upright_tool
from robots.planning.search.escape import EscapeChecker
from robots.planning.search.fast_search import is_tilted
from robots.port import Array

_SAME_RAD = 1e-6


def validate_path(
    request: PlanRequest, goal: PathGoal, checker: ExactChecker, problem: CompiledProblem
) -> tuple[Array, Endpoints] | PlanRefusal:
    """Return the waypoints (k, n) of a given path and its endpoints, or why the arm cannot follow it.

    Raises:
        CellError: the path does not begin at the start configuration.
    """
    start = np.array(request.start_rad, dtype=np.float64)
    rows = [np.array(row, dtype=np.float64) for row in goal.waypoints_rad]
    if not rows or rows[0].shape != start.shape or float(np.abs(rows[0] - start).max()) > _SAME_RAD:
        raise CellError(
            "the given path does not begin at the start configuration",
            where=request.arm,
            hint="use the start configuration as the first waypoint",
        )
    for number, row in enumerate(rows):
        outside = outside_limits(row, problem, checker)
        if outside:
            reason = "goal_outside_limits" if number else "start_outside_limits"
            message = f"waypoint {number} of the given path: {outside}"
            return PlanRefusal(reason=reason, message=message, hint="plan another path")
    # Exactly: the set point moves from where it is.
    path = np.vstack((start, *rows[1:]))
    hit = checker.first_collision(path, query=EscapeChecker(checker, start))
    if hit is not None:
        at_start = hit.segment == 0 and hit.share == 0.0
        where = "at the start" if at_start else f"at {hit.share:.0%} of the segment from waypoint {hit.segment}"
        return PlanRefusal(
            reason="start_in_collision" if at_start else "way_blocked",
            message=f"{where} {describe_collision(checker, hit.joints, hit.pairs)}",
            hint="plan another path, or remove the obstacle",
            pairs=hit.pairs,
        )
    if request.keep_orientation is not None:
        problem = with_upright_tool(problem, start, request.keep_orientation)
        for before, after in pairwise(path):
            count = checker.steps(before, after)
            if any(is_tilted(problem, before + (after - before) * (i / count)) for i in range(1, count + 1)):
                return PlanRefusal(
                    reason="way_blocked",
                    message=f"the tool rotates by more than {problem.tolerance:g} rad on the given path",
                    hint="plan another path, or increase the tolerance",
                )
    return path, Endpoints(lead=path[:0], start=path[0], goals=path[-1:], problem=problem)

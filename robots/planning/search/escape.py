"""Escape from a start within the margin: the arm may come no nearer, and the full margin applies once it is kept."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np

from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair
from robots.planning.search.fast_search import is_tilted
from robots.port import Array

# Accuracy of distances of convex shapes.
_SLACK_M = 1e-4
_FARTHEST_RAD = (0.1, 0.2, 0.4, 0.8)
_DIRECTIONS = 24
_NUDGE_RAD = 1e-3


class EscapeChecker:
    """Checks a path in its order, for an arm that may start within the margin of objects.

    Pairs that are within the margin at the start, but do not touch, may stay as near as there until
    the arm has kept the full margin once; from then on the full margin applies.
    """

    def __init__(self, checker: ExactChecker, start: Array) -> None:
        self._checker = checker
        self._allowed: tuple[dict[int, float], ...] = ()
        if checker.margin_m > 0.0 and checker.in_collision(start):
            self._allowed = tuple(
                {pair: near - _SLACK_M for pair, near in checks.too_near(start).items() if near > 0.0}
                for checks in checker.checks
            )

    @property
    def within_margin(self) -> bool:
        """True until the arm has left the margin."""
        return bool(self._allowed)

    def in_collision(self, joints: Array) -> bool:
        """Return whether any pair is too near at `joints` (n,), the next configuration on the path."""
        if not self._checker.in_collision(joints):
            self.has_left()
            return False
        return not self._allowed or self._is_nearer(joints)

    def has_left(self) -> None:
        """Record that a configuration on the path keeps the full margin."""
        self._allowed = ()

    def colliding_pairs(self, joints: Array) -> tuple[NamePair, ...]:
        """Return the names of all pairs that are too near at `joints` (n,), each once."""
        with self._nearer():
            return self._checker.colliding_pairs(joints)

    def _is_nearer(self, joints: Array) -> bool:
        with self._nearer():
            return self._checker.in_collision(joints)

    def _nearer(self) -> ExitStack:
        stack = ExitStack()
        for checks, allowed in zip(self._checker.checks, self._allowed, strict=False):
            stack.enter_context(checks.nearer(allowed))
        return stack


def escape_configuration(
    checker: ExactChecker, problem: CompiledProblem, start: Array, goals: Array, *, seed: int
) -> Array | None:
    """Return the end (n,) of the shortest straight path found that leaves the margin, or None.

    Tries the directions to the goals, the direction in which the distance grows fastest and, with growing
    length, random directions.
    """
    for goal in goals:
        delta = goal - start
        distance = float(np.linalg.norm(delta))
        if (
            distance > 0.0
            and (end := _first_outside(checker, problem, start, delta / distance, min(distance, _FARTHEST_RAD[-1])))
            is not None
        ):
            return start + end * delta / distance
    random = np.random.default_rng(seed)
    directions = [_fastest(checker, start), *random.standard_normal((_DIRECTIONS, len(start)))]
    for farthest in _FARTHEST_RAD:
        best, escaped = farthest, None
        for direction in directions:
            size = float(np.linalg.norm(direction))
            if size == 0.0:
                continue
            end = _first_outside(checker, problem, start, direction / size, best)
            if end is not None and (escaped is None or end < best):
                best, escaped = end, start + end * direction / size
        if escaped is not None:
            return escaped
    return None


def _first_outside(
    checker: ExactChecker, problem: CompiledProblem, start: Array, direction: Array, farthest: float
) -> float | None:
    """Return the first distance along a direction that keeps the full margin, None if a collision comes before."""
    escape = EscapeChecker(checker, start)
    count = checker.steps(start, start + farthest * direction)
    for i in range(1, count + 1):
        joints = start + (farthest * i / count) * direction
        beyond = ((joints < problem.limits[0]) | (joints > problem.limits[1])).any()
        if beyond or is_tilted(problem, joints) or escape.in_collision(joints):
            return None
        if not escape.within_margin:
            return farthest * i / count
    return None


def _fastest(checker: ExactChecker, start: Array) -> Array:
    """Return the direction in which the pairs within the margin separate fastest, (n,)."""
    within = [sorted(checks.too_near(start)) for checks in checker.checks]

    def total_distance(joints: Array) -> float:
        return sum(float(checks.distances(joints)[k].sum()) for checks, k in zip(checker.checks, within, strict=True))

    initial = total_distance(start)
    return np.array([total_distance(start + step) - initial for step in _NUDGE_RAD * np.eye(len(start))])

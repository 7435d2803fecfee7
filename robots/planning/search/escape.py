"""Leaves from where an arm is nearer to something than the margin: no nearer on the way, and the margin grows back."""

from __future__ import annotations

from contextlib import ExitStack

import numpy as np

from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair
from robots.planning.search.fast_search import is_tilted
from robots.port import Array

# Distances of convex shapes are right to about this.
_SLACK_M = 1e-4
_FARTHEST_RAD = (0.1, 0.2, 0.4, 0.8)
_DIRECTIONS = 24
_NUDGE_RAD = 1e-3


class EscapeChecker:
    """Tells what touches along a way, in its order, for an arm that may begin it nearer to things than the margin.

    Pairs that are within the margin at the start, but do not touch, may stay as near as they are there until
    the whole margin is kept for once; from then on it counts again.
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
        """Whether the arm has not left yet."""
        return bool(self._allowed)

    def in_collision(self, joints: Array) -> bool:
        """Return whether anything is too near at `joints` (n,), the next ones on the way."""
        if not self._checker.in_collision(joints):
            self.has_left()
            return False
        return not self._allowed or self._is_nearer(joints)

    def has_left(self) -> None:
        """Take note of a configuration on the way that keeps the whole margin."""
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
    """Return where the straight way leads that leaves the margin soonest, (n,), or None where none was found.

    Tried are the ways to the goals, the one along which the distance grows fastest and, ever farther,
    random ones.
    """
    for goal in goals:
        away = goal - start
        far = float(np.linalg.norm(away))
        if (
            far > 0.0
            and (end := _first_outside(checker, problem, start, away / far, min(far, _FARTHEST_RAD[-1]))) is not None
        ):
            return start + end * away / far
    random = np.random.default_rng(seed)
    directions = [_fastest(checker, start), *random.standard_normal((_DIRECTIONS, len(start)))]
    for farthest in _FARTHEST_RAD:
        best, found = farthest, None
        for direction in directions:
            size = float(np.linalg.norm(direction))
            if size == 0.0:
                continue
            end = _first_outside(checker, problem, start, direction / size, best)
            if end is not None and (found is None or end < best):
                best, found = end, start + end * direction / size
        if found is not None:
            return found
    return None


def _first_outside(
    checker: ExactChecker, problem: CompiledProblem, start: Array, direction: Array, farthest: float
) -> float | None:
    """Return how far along a direction the whole margin is kept first, None where something is touched before."""
    looking = EscapeChecker(checker, start)
    count = checker.steps(start, start + farthest * direction)
    for i in range(1, count + 1):
        joints = start + (farthest * i / count) * direction
        beyond = ((joints < problem.limits[0]) | (joints > problem.limits[1])).any()
        if beyond or is_tilted(problem, joints) or looking.in_collision(joints):
            return None
        if not looking.within_margin:
            return farthest * i / count
    return None


def _fastest(checker: ExactChecker, start: Array) -> Array:
    """Return the direction in which the pairs within the margin part fastest, (n,)."""
    within = [sorted(checks.too_near(start)) for checks in checker.checks]

    def together(joints: Array) -> float:
        return sum(float(checks.distances(joints)[k].sum()) for checks, k in zip(checker.checks, within, strict=True))

    here = together(start)
    return np.array([together(start + step) - here for step in _NUDGE_RAD * np.eye(len(start))])

"""The interface of all planners: a task with free start and goals and both checkers, a budget; a path or None."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.port import Array


class SearchBudget:
    """Budget of a search: by wall time, or by its number of checks, so that the answer does not depend on the machine.

    Args:
        time_s: Seconds that the search may take.
        check_s: Seconds charged for a check of one configuration; None to use wall time.
        cancelled: Queried between work steps; True ends the search.
    """

    def __init__(
        self, time_s: float, *, check_s: float | None = None, cancelled: Callable[[], bool] = lambda: False
    ) -> None:
        self._time_s = time_s
        self._check_s = check_s
        self._cancelled = cancelled
        self._start_s = time.perf_counter()
        self.checks = 0

    def spend(self, checks: int) -> None:
        """Count checks of configurations."""
        self.checks += checks

    @property
    def left_s(self) -> float:
        """Remaining seconds, at least 0."""
        spent_s = time.perf_counter() - self._start_s if self._check_s is None else self.checks * self._check_s
        return max(0.0, self._time_s - spent_s)

    def part(self, share: float) -> SearchBudget:
        """Return a share of the remaining budget for a subtask; the caller charges its checks to this budget."""
        return SearchBudget(self.left_s * share, check_s=self._check_s, cancelled=self._cancelled)

    @property
    def is_wall_clock(self) -> bool:
        """True if wall time decides, not the number of checks."""
        return self._check_s is None

    @property
    def cancelled(self) -> bool:
        """True if the request was canceled."""
        return self._cancelled()

    @property
    def over(self) -> bool:
        """True when the search must end."""
        return self.left_s <= 0.0 or self.cancelled


@dataclass(frozen=True, kw_only=True)
class SearchTask:
    """A search: from `start` (n,) to any of `goals` (k, n), all free and within the limits."""

    start: Array
    goals: Array
    problem: CompiledProblem
    checker: ExactChecker
    seed: int


class SearchAlgorithm(Protocol):
    """A planner: searches for a path of straight joint lines."""

    def __call__(self, task: SearchTask, budget: SearchBudget) -> Array | None:
        """Return waypoints (k, n) from the start to a goal, None when the budget is spent."""
        ...

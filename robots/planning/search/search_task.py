"""What every planner gets and gives: start and goals that are free, both checkers, a budget; a way or nothing."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.scene.exact_checker import ExactChecker
from robots.port import Array


class SearchBudget:
    """How long a search may go on: by the clock, or by its checks, so that the answer never depends on the machine.

    Args:
        time_s: Seconds that may be spent.
        check_s: What a check of one configuration counts as; None to go by the clock.
        cancelled: Asked between pieces of work; True ends the search.
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
        """Seconds that are left, 0 at least."""
        spent_s = time.perf_counter() - self._start_s if self._check_s is None else self.checks * self._check_s
        return max(0.0, self._time_s - spent_s)

    def part(self, share: float) -> SearchBudget:
        """Return a share of what is left, for a piece of the work; who uses it tells this one what it spent."""
        return SearchBudget(self.left_s * share, check_s=self._check_s, cancelled=self._cancelled)

    @property
    def is_wall_clock(self) -> bool:
        """Whether the clock decides, not the number of checks."""
        return self._check_s is None

    @property
    def cancelled(self) -> bool:
        """Whether the answer is no longer wanted."""
        return self._cancelled()

    @property
    def over(self) -> bool:
        """Whether to give up."""
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
    """A planner: looks for a way of straight joint lines."""

    def __call__(self, task: SearchTask, budget: SearchBudget) -> Array | None:
        """Return waypoints (k, n) from the start to a goal, None when the budget is spent."""
        ...

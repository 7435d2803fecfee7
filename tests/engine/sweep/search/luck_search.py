"""A search over the project of luck, executed without processes."""

from __future__ import annotations

from collections.abc import Iterator
from types import TracebackType
from typing import Self

from engine.document.sweep import Sweep
from engine.sweep import Configuration, SweepSubject, TrialResult, WorkerOptions
from tests.engine.sweep.luck_project import LuckProject

LIMIT = 0.9
"""The luck from which runs fail."""


def luck_search(project: LuckProject, *, time: float | None = None, **search: object) -> Sweep:
    """Return a search for runs with too much luck, which take longest."""
    factors = {"parameters.luck": {"uniform": [0.0, 1.0]}, "parameters.otherwise": {"values": ["miss", "raise"]}}
    keys = {"time": time} if time is not None else {}
    spec = {"runs": 60, "batch": 10, "elite": 0.4, "towards": "most duration_s", **search}
    return project.sweep(factors=factors, parameters={"rate": LIMIT}, search=spec, **keys)


def luck_result(configuration: Configuration) -> TrialResult:
    """Return how a run of the project ends, without executing it."""
    luck = float(str(configuration.values["parameters.luck"]))
    raised = configuration.values["parameters.otherwise"] == "raise"
    if luck < LIMIT:
        return TrialResult(
            configuration=configuration, status="finished", outcome="done", success=True, duration_s=1.0 + luck
        )
    return TrialResult(
        configuration=configuration,
        status="errored" if raised else "finished",
        outcome=None if raised else "missed",
        reason=f"the luck was {luck:.3f}" if raised else "missed",
        reason_at="cup" if raised else "root.only",
        duration_s=1.0 + luck,
    )


class ReversedPool:
    """Executes runs in this process, and yields the last of what is running first."""

    def __init__(self, subject: SweepSubject, options: WorkerOptions) -> None:
        self._options = options

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        pass

    def results(self, due: Iterator[Configuration]) -> Iterator[TrialResult]:
        """Yield results as if so many processes executed them as the options say."""
        running: list[Configuration] = []
        while True:
            while len(running) < self._options.workers and (configuration := next(due, None)) is not None:
                running.append(configuration)
            if not running:
                return
            yield luck_result(running.pop())

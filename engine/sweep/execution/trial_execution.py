"""Where the runs of a sweep are executed: what the driver of a sweep asks of it, and the limits of one process."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.subject.sweep_subject import SweepSubject

DEFAULT_MEMORY_BYTES = 4 * 2**30
DEFAULT_RUNS_OF_PROCESS = 200


@dataclass(frozen=True, kw_only=True)
class ProcessLimits:
    """The limits of each process that executes runs, on whatever machine: nothing of it changes a result."""

    timeout_s: float = 300.0
    """Wall time of one run, after which its process is killed."""
    memory_bytes: int = DEFAULT_MEMORY_BYTES
    """Memory for the data of one process."""
    runs_of_process: int = DEFAULT_RUNS_OF_PROCESS
    """Runs after which a process is replaced."""


class TrialExecutor(Protocol):
    """Executes configurations in processes, which end with the block."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def results(self, due: Iterator[Configuration]) -> Iterator[TrialResult]:
        """Yield the result of each configuration as it ends; the next ones begin meanwhile.

        A configuration whose process crashes or takes too long ends with that status, and is not executed again.
        Configurations are taken from `due` when there is room for them; it may end at any time.

        Raises:
            FlexcellError: nothing can be executed any more.
        """
        ...


class ExecutionOptions(Protocol):
    """Where and with which limits runs are executed: `WorkerOptions` for this machine, `ClusterOptions` for others."""

    def new_executor(self, subject: SweepSubject) -> TrialExecutor:
        """Return what executes the runs of a subject."""
        ...

"""Worker processes of this machine that execute the configurations of a sweep.

Everything here belongs to the thread that iterates `results`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from multiprocessing.connection import wait
from types import TracebackType
from typing import Self

from engine.errors import FlexcellError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_execution import ProcessLimits, TrialExecutor
from engine.sweep.execution.trial_process import TrialProcess
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.execution.worker import WorkerAnswer, WorkerTask
from engine.sweep.subject.sweep_subject import SweepSubject


@dataclass(frozen=True, kw_only=True)
class WorkerOptions(ProcessLimits):
    """How runs are executed on this machine."""

    workers: int = 1

    def new_executor(self, subject: SweepSubject) -> TrialExecutor:
        """Return a pool of processes."""
        return WorkerPool(subject, self)


class WorkerPool:
    """A `TrialExecutor` of this machine.

    Args:
        subject: What all configurations have in common.
        options: Number and limits of the processes.
    """

    def __init__(self, subject: SweepSubject, options: WorkerOptions) -> None:
        self._subject = subject
        self._options = options
        self._workers: list[TrialProcess] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for worker in self._workers:
            worker.end()
        self._workers.clear()

    def results(self, due: Iterator[Configuration]) -> Iterator[TrialResult]:
        """Yield the result of each configuration as it ends; see `TrialExecutor`.

        Raises:
            FlexcellError: a process cannot be started, or cannot load the documents.
        """
        while True:
            self._occupy(due)
            busy = [worker for worker in self._workers if worker.is_busy]
            if not busy:
                return
            timeout_s = max(min(worker.left_s for worker in busy), 0.0)
            ready = wait([worker.connection for worker in busy], timeout=timeout_s)
            for worker in busy:
                if worker.connection in ready:
                    yield self._result(worker, worker.answer())
                elif worker.left_s <= 0.0:
                    yield self._result(worker, worker.hung())

    def _occupy(self, due: Iterator[Configuration]) -> None:
        """Give each process that has none the next configuration; start the processes that are missing."""
        for worker in self._workers:
            if not worker.is_busy and (configuration := next(due, None)) is not None:
                worker.give(configuration)
        while len(self._workers) < self._options.workers and (configuration := next(due, None)) is not None:
            worker = TrialProcess(self._task(), self._options)
            self._workers.append(worker)
            worker.give(configuration)

    def _task(self) -> WorkerTask:
        sweep = self._subject.sweep
        return WorkerTask(
            document=sweep.text.decode(),
            file=str(sweep.file),
            versions=self._subject.versions,
            memory_bytes=self._options.memory_bytes,
        )

    def _result(self, worker: TrialProcess, answer: WorkerAnswer) -> TrialResult:
        if worker.is_spent:
            self._workers.remove(worker)
            worker.end()
        if answer.result is None:
            raise FlexcellError(answer.failure)
        return answer.result

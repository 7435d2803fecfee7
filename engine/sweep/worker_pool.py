"""Worker processes of this machine that execute the configurations of a sweep.

Everything here belongs to the thread that iterates `results`. A process has one configuration at a time and a socket
of its own, so that its end, whatever the cause, concerns this configuration only, and no other.
"""

from __future__ import annotations

import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from types import TracebackType
from typing import Self

import msgspec

from engine.errors import FlexcellError
from engine.host.child_process import describe_exit, start_child
from engine.sweep.configuration import Configuration
from engine.sweep.subject import SweepSubject
from engine.sweep.trial import ended_process
from engine.sweep.trial_result import TrialResult
from engine.sweep.worker import CODE, WorkerAnswer, WorkerTask

DEFAULT_MEMORY_BYTES = 4 * 2**30
DEFAULT_RUNS_OF_PROCESS = 200
_NAME = "the worker of the sweep"
_MUCH = 0.5
"""A process that has needed this share of its memory is replaced: what it keeps may grow."""


@dataclass(frozen=True, kw_only=True)
class WorkerOptions:
    """How runs are executed: nothing of it changes a result."""

    workers: int = 1
    timeout_s: float = 300.0
    """Wall time of one run, after which its process is killed."""
    memory_bytes: int = DEFAULT_MEMORY_BYTES
    """Memory for the data of one process."""
    runs_of_process: int = DEFAULT_RUNS_OF_PROCESS
    """Runs after which a process is replaced."""


@dataclass(kw_only=True)
class _Worker:
    process: subprocess.Popen[bytes]
    connection: Connection
    runs: int = 0
    configuration: Configuration | None = None
    began_s: float = field(default_factory=time.monotonic)

    def give(self, configuration: Configuration) -> None:
        self.configuration, self.began_s = configuration, time.monotonic()
        self.connection.send_bytes(msgspec.json.encode(configuration))

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        self.connection.close()


class WorkerPool:
    """Executes configurations in processes, which end with the block.

    Args:
        subject: What all configurations have in common.
        options: Number and limits of the processes.
    """

    def __init__(self, subject: SweepSubject, options: WorkerOptions) -> None:
        self._subject = subject
        self._options = options
        self._workers: list[_Worker] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for worker in self._workers:
            worker.end()
        self._workers.clear()

    def results(self, due: Iterator[Configuration]) -> Iterator[TrialResult]:
        """Yield the result of each configuration as it ends; the next ones begin meanwhile.

        A configuration whose process crashes or takes too long ends with that status, and is not executed again.

        Raises:
            FlexcellError: a process cannot be started, or cannot load the documents.
        """
        while True:
            self._occupy(due)
            busy = [worker for worker in self._workers if worker.configuration is not None]
            if not busy:
                return
            now_s, timeout_s = time.monotonic(), self._options.timeout_s
            ready = wait(
                [worker.connection for worker in busy],
                timeout=max(min(worker.began_s for worker in busy) + timeout_s - now_s, 0.0),
            )
            for worker in busy:
                if worker.connection in ready:
                    yield self._answer(worker)
                elif time.monotonic() - worker.began_s >= timeout_s:
                    yield self._hung(worker)

    def _occupy(self, due: Iterator[Configuration]) -> None:
        """Give each process that has none the next configuration; start the processes that are missing."""
        for worker in tuple(self._workers):
            if worker.configuration is None and (configuration := next(due, None)) is not None:
                self._give(worker, configuration)
        while len(self._workers) < self._options.workers and (configuration := next(due, None)) is not None:
            self._give(self._start(), configuration)

    def _give(self, worker: _Worker, configuration: Configuration) -> None:
        # A process that was killed while it waited is known by the end of its socket when the answer is read.
        with suppress(BrokenPipeError, ConnectionResetError):
            worker.give(configuration)

    def _start(self) -> _Worker:
        ours, theirs = socket.socketpair()
        with ours, theirs:
            process = start_child(CODE, [theirs.fileno()], what=_NAME)
            worker = _Worker(process=process, connection=Connection(ours.detach()))
        self._workers.append(worker)
        sweep = self._subject.sweep
        task = WorkerTask(
            document=sweep.text.decode(),
            file=str(sweep.file),
            subject=self._subject.hash,
            memory_bytes=self._options.memory_bytes,
        )
        with suppress(BrokenPipeError, ConnectionResetError):
            worker.connection.send_bytes(msgspec.json.encode(task))
        return worker

    def _answer(self, worker: _Worker) -> TrialResult:
        configuration = worker.configuration
        assert configuration is not None
        try:
            answer = msgspec.json.decode(worker.connection.recv_bytes(), type=WorkerAnswer)
        except (EOFError, OSError, msgspec.DecodeError):
            message = describe_exit(worker.process, what="the process of this run")
            self._discard(worker)
            return ended_process(configuration, "crashed", message, wall_s=time.monotonic() - worker.began_s)
        if answer.result is None:
            raise FlexcellError(answer.failure)
        worker.configuration = None
        worker.runs += 1
        grown = answer.result.memory_bytes > _MUCH * self._options.memory_bytes
        if grown or worker.runs >= self._options.runs_of_process:
            self._discard(worker)
        return answer.result

    def _hung(self, worker: _Worker) -> TrialResult:
        configuration = worker.configuration
        assert configuration is not None
        self._discard(worker)
        message = f"the run took longer than {self._options.timeout_s:g} s of wall time: its process was killed"
        return ended_process(configuration, "hung", message, wall_s=time.monotonic() - worker.began_s)

    def _discard(self, worker: _Worker) -> None:
        self._workers.remove(worker)
        worker.end()

"""One process that executes configurations of a sweep, one after the other, as its parent sees it.

Its socket belongs to it alone, so that its end, whatever the cause, concerns the configuration that it has and no
other.
"""

from __future__ import annotations

import socket
import time
from contextlib import suppress
from multiprocessing.connection import Connection
from tempfile import TemporaryDirectory

import msgspec

from engine.host.child_process import describe_exit, start_child
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial import ended_process
from engine.sweep.execution.trial_execution import ProcessLimits
from engine.sweep.execution.trial_result import TrialResult, TrialStatus
from engine.sweep.execution.worker import CODE, WorkerAnswer, WorkerTask

_NAME = "the worker of the sweep"
_MUCH = 0.5
"""A process that has needed this share of its memory is replaced: what it keeps may grow."""


class TrialProcess:
    """A started process; belongs to one thread, and ends at the latest with that thread.

    Args:
        task: What it executes runs of.
        limits: Its limits.

    Raises:
        RobotError: it does not start.
    """

    def __init__(self, task: WorkerTask, limits: ProcessLimits) -> None:
        self._limits = limits
        self._scratch = TemporaryDirectory(prefix="flexcell-sweep-", ignore_cleanup_errors=True)
        ours, theirs = socket.socketpair()
        with ours, theirs:
            self._process = start_child(CODE, [theirs.fileno()], what=_NAME)
            self.connection = Connection(ours.detach())
        self._configuration: Configuration | None = None
        self._started_s = time.monotonic()
        self._runs = 0
        self.is_spent = False
        """Whether it executes no further configuration: it has ended, or is to be replaced."""
        self._send(msgspec.json.encode(msgspec.structs.replace(task, scratch=self._scratch.name)))

    @property
    def is_busy(self) -> bool:
        """Whether it has a configuration without a result."""
        return self._configuration is not None

    @property
    def left_s(self) -> float:
        """The wall time that its run may still take; negative when it has taken too long."""
        return self._started_s + self._limits.timeout_s - time.monotonic()

    def give(self, configuration: Configuration) -> None:
        """Let it begin a configuration."""
        self._configuration, self._started_s = configuration, time.monotonic()
        self._send(msgspec.json.encode(configuration))

    def answer(self) -> WorkerAnswer:
        """Return how its configuration ended, once its connection can be read."""
        try:
            answer = msgspec.json.decode(self.connection.recv_bytes(), type=WorkerAnswer)
        except (EOFError, OSError, msgspec.DecodeError):
            return self._ended("crashed", describe_exit(self._process, what="the process of this run"))
        self._configuration = None
        self._runs += 1
        is_large = answer.result is not None and answer.result.memory_bytes > _MUCH * self._limits.memory_bytes
        self.is_spent = is_large or answer.result is None or self._runs >= self._limits.runs_of_process
        return answer

    def hung(self) -> WorkerAnswer:
        """End its run, which took too long, and return that."""
        message = f"the run took longer than {self._limits.timeout_s:g} s of wall time: its process was killed"
        return self._ended("hung", message)

    def execute(self, configuration: Configuration) -> WorkerAnswer:
        """Execute one configuration and wait until it has ended."""
        self.give(configuration)
        return self.answer() if self.connection.poll(self._limits.timeout_s) else self.hung()

    def kill(self) -> None:
        """Kill the process from any thread and wait for its end; who waits for its answer reads that it has crashed."""
        self._process.kill()
        self._process.wait()

    def end(self) -> None:
        """Kill the process, and wait until it has ended."""
        self.is_spent = True
        self._process.kill()
        self._process.wait()
        self.connection.close()
        self._scratch.cleanup()

    def _ended(self, status: TrialStatus, message: str) -> WorkerAnswer:
        assert self._configuration is not None
        wall_s = time.monotonic() - self._started_s
        result: TrialResult = ended_process(self._configuration, status, message, wall_s=wall_s)
        self.end()
        return WorkerAnswer(result=result)

    def _send(self, data: bytes) -> None:
        # A process that was killed while it waited is known by the end of its socket when the answer is read.
        with suppress(BrokenPipeError, ConnectionResetError):
            self.connection.send_bytes(data)

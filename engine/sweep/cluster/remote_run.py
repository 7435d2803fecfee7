"""What a worker of a Dask cluster executes: one configuration, in a process of its own.

A thread of the worker keeps its process for the next configuration. Files and processes of a sweep are removed when its
driver says so, or when nothing of it has been executed for a while: the driver may have been killed.
"""

from __future__ import annotations

import shutil
import tempfile
import threading
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from engine.sweep.cluster.shipment import Shipment
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_execution import ProcessLimits
from engine.sweep.execution.trial_process import TrialProcess
from engine.sweep.execution.worker import WorkerAnswer, WorkerTask
from engine.sweep.subject.sweep_subject import environment_versions

_IDLE_S = 60.0
_KNOWN_S = 1.0
"""Time in which the scheduler answers that there is no result."""


class RemoteTask(msgspec.Struct, frozen=True, kw_only=True):
    """What all configurations of one execution of a sweep have in common, beside its files."""

    token: str
    """A name that no other execution has."""
    versions: Mapping[str, str]
    timeout_s: float
    memory_bytes: int
    runs_of_process: int


class RemoteAnswer(msgspec.Struct, frozen=True, kw_only=True):
    """How a configuration ended; `answer` is None if the worker on which it had begun was lost before its end."""

    answer: WorkerAnswer | None = None
    worker: str = ""
    """The address of the worker."""


def claim_name(token: str, number: int) -> str:
    """Return the name of the flag that is set when a configuration begins."""
    return f"flexcell-{token}-{number}"


def shipped(shipment: bytes) -> bytes:
    """Return the files of a sweep: Dask brings the result of this task to each worker that executes configurations."""
    return shipment


def execute_remotely(shipment: bytes, task: bytes, configuration: bytes) -> bytes:
    """Execute a configuration, unless it has begun before; Dask repeats what was on a worker that it has lost.

    Arguments and result are JSON or MessagePack: the scheduler handles them without knowing our types.
    """
    from distributed import Event, Variable, get_worker

    asked = msgspec.json.decode(task, type=RemoteTask)
    decoded = msgspec.json.decode(configuration, type=Configuration)
    begun = Event(claim_name(asked.token, decoded.number))
    # Dask has no types.
    ended: Any = Variable(claim_name(asked.token, decoded.number))
    if begun.is_set():
        try:
            result: bytes = ended.get(timeout=_KNOWN_S)
        except TimeoutError:
            result = msgspec.json.encode(RemoteAnswer())
        return result
    begun.set()
    worker = get_worker()
    site = _entered(asked, shipment, worker.local_directory)
    if site is None:
        return msgspec.json.encode(RemoteAnswer())
    try:
        answer = site.execute(decoded)
    finally:
        site.leave()
    answered = msgspec.json.encode(RemoteAnswer(answer=answer, worker=str(worker.address)))
    # Results lie on their workers until the driver takes them; this one outlives its worker.
    ended.set(answered)
    return answered


def local_versions() -> dict[str, str]:
    """Return the versions of Python and of the packages of this machine."""
    return environment_versions()


def release(token: str) -> None:
    """End what this worker still executes of a sweep, and remove its files; nothing of it begins any more."""
    with _lock:
        _released.add(token)
        site = _sites.pop(token, None)
    if site is not None:
        site.end()


class _Site:
    """The files and processes of one sweep in this process of Dask.

    Args:
        task: What is executed.
        shipment: Its files.
        folder: An empty folder for them.
    """

    def __init__(self, task: RemoteTask, shipment: Shipment, folder: Path) -> None:
        self._folder = folder
        shipment.unpack(folder)
        self._token = task.token
        self._limits = ProcessLimits(
            timeout_s=task.timeout_s, memory_bytes=task.memory_bytes, runs_of_process=task.runs_of_process
        )
        self._task = WorkerTask(
            document=shipment.document,
            file=str(folder / shipment.file),
            versions=task.versions,
            memory_bytes=task.memory_bytes,
            folder=str(folder),
        )
        self._processes: dict[int, TrialProcess] = {}
        self._users = 0
        self._idle: threading.Timer | None = None
        self._ended = False

    def enter(self) -> None:
        """Keep files and processes while a configuration is executed; called with the lock."""
        self._users += 1
        if self._idle is not None:
            self._idle.cancel()
            self._idle = None

    def leave(self) -> None:
        """Let them be removed if nothing else is executed for a while."""
        with _lock:
            self._users -= 1
            if not self._users and not self._ended:
                self._idle = threading.Timer(_IDLE_S, self._end_if_idle)
                self._idle.daemon = True
                self._idle.start()

    def execute(self, configuration: Configuration) -> WorkerAnswer:
        """Execute a configuration in the process of this thread."""
        thread = threading.get_ident()
        process = self._processes.get(thread)
        if process is None:
            process = TrialProcess(self._task, self._limits)
            with _lock:
                self._processes[thread] = process
                ended = self._ended
            if ended:
                # The sweep was released while the process started; it may have written byte code since.
                process.kill()
                shutil.rmtree(self._folder, ignore_errors=True)
        answer = process.execute(configuration)
        if process.is_spent:
            with _lock:
                self._processes.pop(thread, None)
            process.end()
        return answer

    def end(self) -> None:
        """End all processes and remove the files; a thread that waits for a process reads that it has crashed."""
        with _lock:
            self._ended = True
            processes = list(self._processes.values())
            if self._idle is not None:
                self._idle.cancel()
        for process in processes:
            # The thread that waits for one ends it, as soon as it reads that it was killed.
            process.kill() if process.is_busy else process.end()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _end_if_idle(self) -> None:
        with _lock:
            if self._users:
                return
            _sites.pop(self._token, None)
        self.end()


def _entered(task: RemoteTask, shipment: bytes, local_directory: str) -> _Site | None:
    """Return the files and processes of a sweep on this worker, kept until `leave`; the first caller unpacks them.

    None for a sweep that was released: a configuration whose cancellation comes after that does not begin.
    """
    with _lock:
        if task.token in _released:
            return None
        site = _sites.get(task.token)
        if site is None:
            folder = Path(tempfile.mkdtemp(prefix="flexcell-sweep-", dir=local_directory))
            site = _sites[task.token] = _Site(task, msgspec.msgpack.decode(shipment, type=Shipment), folder)
        site.enter()
        return site


_lock = threading.Lock()
_sites: dict[str, _Site] = {}
_released: set[str] = set()

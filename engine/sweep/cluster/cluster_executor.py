"""Executes the configurations of a sweep on the workers of a Dask cluster; loads Dask when it connects."""

from __future__ import annotations

import logging
import time
import uuid
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import Any, Self

import msgspec

from engine.errors import FlexcellError
from engine.sweep.cluster.remote_run import (
    RemoteAnswer,
    RemoteTask,
    claim_name,
    execute_remotely,
    local_versions,
    release,
    shipped,
)
from engine.sweep.cluster.shipment import pack
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial import ended_process
from engine.sweep.execution.trial_execution import ProcessLimits, TrialExecutor
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.subject.sweep_subject import SweepSubject, environment_versions, other_versions

_LOOK_S = 5.0
"""Interval at which workers are counted, and the longest time until Ctrl-C is noticed."""
_SAVED = "what had ended is saved: the same command goes on with what is left, on this cluster, another one or none"
_SAME = "install the same packages on this machine, the scheduler and all workers: one image or one lock file"


@dataclass(frozen=True, kw_only=True)
class ClusterOptions(ProcessLimits):
    """The scheduler of a Dask cluster that exists. What is not given here is that of Dask's own configuration."""

    scheduler: str
    """Its address, `tls://HOST:8786` or `tcp://HOST:8786`."""
    tls_ca_file: Path | None = None
    """Certificate of the authority that has signed those of the cluster, PEM."""
    tls_cert: Path | None = None
    """Certificate of this client, PEM."""
    tls_key: Path | None = None
    """Its private key, PEM; by default it is in the file of the certificate."""
    connect_s: float = 20.0
    """Time until the scheduler must have answered."""
    workers_s: float = 120.0
    """Time that the cluster may be without any worker before the sweep ends."""

    def new_executor(self, subject: SweepSubject) -> TrialExecutor:
        """Return what executes runs on the workers of the cluster.

        Raises:
            FlexcellError: Dask is not installed here.
        """
        if find_spec("distributed") is None:
            raise FlexcellError(
                "Dask is not installed", where=self.scheduler, hint="pip install 'flexcell[dask]', there too"
            )
        return ClusterExecutor(subject, self)


_log = logging.getLogger("distributed.client")


class ClusterExecutor:
    """A `TrialExecutor` of a cluster; belongs to one thread.

    Dask executes a task again whose worker it has lost. A flag on the scheduler, which each configuration sets when it
    begins, lets this attempt end at once: the configuration has crashed.

    Args:
        subject: What all configurations have in common.
        options: The cluster.
    """

    def __init__(self, subject: SweepSubject, options: ClusterOptions) -> None:
        self._subject = subject
        self._options = options
        self._token = uuid.uuid4().hex
        # Dask has no types.
        self._client: Any = None
        self._shipped: Any = None
        self._task = b""
        self._begun: dict[str, tuple[Any, Configuration, float]] = {}
        self._ended: SimpleQueue[Any] = SimpleQueue()
        self._looked_s = self._without_s = 0.0
        self._room = 0
        self._log_level = _log.level

    def __enter__(self) -> Self:
        """Connect, compare versions, and send the files of the sweep.

        Raises:
            FlexcellError: the scheduler does not answer, or a machine has other packages.
        """
        files = msgspec.msgpack.encode(pack(self._subject))
        # What its client logs are tracebacks of what this class tells.
        _log.setLevel(logging.CRITICAL)
        try:
            self._client = _connected(self._options)
            self._require_versions()
            self._send(files)
        except BaseException:
            self._close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Cancel what has not begun, end what has, and remove the files; other work of the cluster is not touched."""
        left = list(self._begun.values())
        self._begun.clear()
        # Without a scheduler there is nothing to tidy; its workers do it by themselves.
        with suppress(OSError, RuntimeError, ValueError, TimeoutError):
            if self._client.status == "running":
                self._client.cancel([future for future, _, _ in left], force=True)
                self._client.run(release, self._token, on_error="ignore")
                for _, configuration, _ in left:
                    self._forget(configuration)
        self._close()

    def results(self, due: Iterator[Configuration]) -> Iterator[TrialResult]:
        """Yield the result of each configuration as it ends; see `TrialExecutor`.

        Raises:
            FlexcellError: the scheduler or all workers are gone, or a worker cannot load the documents.
        """
        while True:
            self._look()
            while len(self._begun) < self._room and (configuration := next(due, None)) is not None:
                self._begin(configuration)
            if not self._begun:
                return
            with suppress(Empty):
                future = self._ended.get(timeout=_LOOK_S)
                _, configuration, started_s = self._begun[future.key]
                result = self._result(future, configuration, started_s)
                del self._begun[future.key]
                self._forget(configuration)
                yield result

    def _close(self) -> None:
        with suppress(OSError, RuntimeError, TimeoutError):
            if self._client is not None:
                self._client.close()
        _log.setLevel(self._log_level)

    def _begin(self, configuration: Configuration) -> None:
        future = self._client.submit(
            execute_remotely,
            self._shipped,
            self._task,
            msgspec.json.encode(configuration),
            key=f"{claim_name(self._token, configuration.number)}-run",
            pure=False,
            retries=0,
        )
        self._begun[future.key] = future, configuration, time.monotonic()
        future.add_done_callback(self._ended.put)

    def _result(self, future: Any, configuration: Configuration, started_s: float) -> TrialResult:
        """Return how a configuration ended, from its task."""
        from distributed.scheduler import KilledWorker

        try:
            answered = msgspec.json.decode(future.result(), type=RemoteAnswer)
        except KilledWorker as error:
            return self._lost(configuration, f"{error.last_worker.address}, the last of several,", started_s)
        except Exception as error:
            # Dask passes on whatever a task has raised, and errors of its own when it has lost the scheduler.
            raise self._failure(error) from error
        if answered.answer is None:
            return self._lost(configuration, "it", started_s)
        if answered.answer.result is None:
            raise FlexcellError(answered.answer.failure, where=answered.worker, hint=_SAME)
        return answered.answer.result

    def _lost(self, configuration: Configuration, worker: str, started_s: float) -> TrialResult:
        message = f"the worker of the cluster was lost while {worker} had this run, or before its result had arrived"
        return ended_process(configuration, "crashed", message, wall_s=time.monotonic() - started_s)

    def _failure(self, error: Exception) -> FlexcellError:
        if self._client.status != "running":
            return FlexcellError("the scheduler of the cluster is gone", where=self._options.scheduler, hint=_SAVED)
        if isinstance(error, ImportError):
            return FlexcellError(f"a worker cannot load flexcell: {error}", where=self._options.scheduler, hint=_SAME)
        # The scheduler unpacks tasks, and tells with several lines that it cannot.
        text = " ".join(str(error).split())
        hint = _SAME if "deserialization" in text else _SAVED
        return FlexcellError(f"the cluster cannot execute a run: {text}", where=self._options.scheduler, hint=hint)

    def _look(self) -> None:
        """Count the workers from time to time: as many runs are on the way as they have threads.

        One more would wait on a worker, perhaps behind a run that hangs, while others are idle.
        """
        now_s = time.monotonic()
        if now_s < self._looked_s + _LOOK_S:
            return
        try:
            threads: Mapping[str, int] = self._client.nthreads()
        except (OSError, ValueError, RuntimeError, TimeoutError) as error:
            raise self._failure(error) from error
        self._looked_s = now_s
        self._room = max(sum(threads.values()), 1)
        if threads or not self._without_s:
            self._without_s = now_s
        elif now_s - self._without_s > self._options.workers_s:
            where = self._options.scheduler
            raise FlexcellError("the cluster has no workers", where=where, hint=f"start some; {_SAVED}")

    def _require_versions(self) -> None:
        """Compare the packages of the workers that are there; one that comes later is compared with its first run."""
        due = environment_versions()
        found: dict[str, object] = self._client.run(local_versions, on_error="return")
        other: dict[str, str] = {}
        for worker, versions in found.items():
            if isinstance(versions, ImportError):
                other[worker] = f"flexcell cannot be loaded: {versions}"
            elif isinstance(versions, Exception):
                other[worker] = f"it does not answer: {versions}"
            elif text := other_versions(msgspec.convert(versions, dict[str, str]), due):
                other[worker] = text
        if other:
            first = next(iter(other))
            raise FlexcellError(
                f"{len(other)} of {len(found)} workers have other packages than this machine: {other[first]}",
                where=first,
                hint=_SAME,
            )

    def _send(self, files: bytes) -> None:
        options = self._options
        task = RemoteTask(
            token=self._token,
            versions=self._subject.versions,
            timeout_s=options.timeout_s,
            memory_bytes=options.memory_bytes,
            runs_of_process=options.runs_of_process,
        )
        self._task = msgspec.json.encode(task)
        self._shipped = self._client.submit(shipped, files, key=f"flexcell-{self._token}-files", pure=False)

    def _forget(self, configuration: Configuration) -> None:
        """Remove the flag and the result of a configuration from the scheduler."""
        from distributed import Event, Variable

        name = claim_name(self._token, configuration.number)
        with suppress(OSError, RuntimeError, TimeoutError):
            Event(name, client=self._client).clear()
            Variable(name, client=self._client).delete()


def _connected(options: ClusterOptions) -> Any:
    from distributed import Client, Security

    given = {
        "tls_ca_file": options.tls_ca_file,
        "tls_client_cert": options.tls_cert,
        "tls_client_key": options.tls_key,
    }
    files = {name: str(file) for name, file in given.items() if file is not None}
    missing = next((file for file in given.values() if file is not None and not file.is_file()), None)
    if missing is not None:
        raise FlexcellError("there is no such file", where=missing, hint="a certificate or key in PEM")
    try:
        # Without files of ours, those of Dask's configuration are used.
        return Client(
            options.scheduler,
            security=Security(**files),
            timeout=options.connect_s,
            set_as_default=False,
            name="flexcell-sweep",
        )
    except (OSError, ValueError, TypeError, RuntimeError) as error:
        raise FlexcellError(
            f"no scheduler answers there: {error}",
            where=options.scheduler,
            hint="a running scheduler, `tls://HOST:8786` with `--tls-ca-file`, `--tls-cert` and `--tls-key`, or `tcp://…`",
        ) from error

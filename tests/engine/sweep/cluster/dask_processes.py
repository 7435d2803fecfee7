"""A Dask cluster with TLS on this machine: a scheduler and workers as processes, as an administrator starts them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import trustme
from distributed import Client, Security

from engine.sweep.cluster.cluster_executor import ClusterOptions

_START_S = 120.0


class DaskProcesses:
    """A scheduler, and workers of one thread each; they end with the block.

    Args:
        folder: For certificates, logs and the files of workers.
        workers: The number of workers.
    """

    def __init__(self, folder: Path, workers: int) -> None:
        self.folder = folder
        self.workers: list[subprocess.Popen[bytes]] = []
        self._count = workers
        self._client: Any = None

    def __enter__(self) -> Self:
        authority = trustme.CA()
        authority.cert_pem.write_to_path(self.folder / "ca.pem")
        authority.issue_cert("127.0.0.1").private_key_and_cert_chain_pem.write_to_path(self.folder / "cluster.pem")
        certificate = authority.issue_cert("127.0.0.1")
        certificate.cert_chain_pems[0].write_to_path(self.folder / "client.pem")
        certificate.private_key_pem.write_to_path(self.folder / "key.pem")
        file = self.folder / "scheduler.json"
        self.scheduler = self._start("scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", str(file))
        for _ in range(self._count):
            self.start_worker()
        security = Security(
            tls_ca_file=str(self.folder / "ca.pem"),
            tls_client_cert=str(self.folder / "client.pem"),
            tls_client_key=str(self.folder / "key.pem"),
        )
        self._client = Client(scheduler_file=str(file), security=security, set_as_default=False, timeout=_START_S)
        self.address = str(self._client.scheduler.address)
        self.wait_for_workers(self._count)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._client.close()
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()

    def options(self, *, timeout_s: float = 60.0) -> ClusterOptions:
        """Return options that reach the cluster."""
        return ClusterOptions(
            scheduler=self.address,
            tls_ca_file=self.folder / "ca.pem",
            tls_cert=self.folder / "client.pem",
            tls_key=self.folder / "key.pem",
            timeout_s=timeout_s,
        )

    def start_worker(self) -> None:
        """Start one more worker; its files do not lie where those of the tests are."""
        place = self._place(len(self.workers))
        place.mkdir()
        self.workers.append(
            self._start(
                "worker", "--scheduler-file", str(self.folder / "scheduler.json"), "--nthreads", "1", "--no-nanny",
                "--no-dashboard", "--local-directory", str(place),
            )
        )  # fmt: skip

    def wait_for_workers(self, count: int) -> None:
        """Wait until the scheduler has so many workers."""
        self._client.wait_for_workers(count, timeout=_START_S)

    def processes_of_runs(self) -> list[int]:
        """Return the ids of the processes that workers execute runs in."""
        return [child for worker in self.workers for child in _children(worker.pid)]

    def folders_of_runs(self) -> list[Path]:
        """Return the folders of sweeps on workers that are there; one that was killed leaves its own behind."""
        left = [self._place(number) for number, worker in enumerate(self.workers) if worker.poll() is None]
        return [folder for place in left for folder in place.rglob("flexcell-sweep-*")]

    def _place(self, number: int) -> Path:
        return self.folder / f"worker{number}"

    def _start(self, program: str, *arguments: str) -> subprocess.Popen[bytes]:
        tls = ["--tls-ca-file", str(self.folder / "ca.pem"), "--tls-cert", str(self.folder / "cluster.pem")]
        command = [sys.executable, "-m", f"distributed.cli.dask_{program}", *arguments, "--host", "127.0.0.1", *tls]
        with (self.folder / f"{program}.log").open("ab") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, cwd=self.folder)


def _children(pid: int) -> list[int]:
    text = Path(f"/proc/{pid}/task").glob("*/children")
    return [int(each) for file in text for each in file.read_text(encoding="ascii").split()]

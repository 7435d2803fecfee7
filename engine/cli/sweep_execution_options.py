"""Where `flexcell sweep` executes runs, from its options: in processes of this machine, or on a Dask cluster."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from engine.errors import FlexcellError
from engine.sweep import ClusterOptions, WorkerOptions
from engine.sweep.execution.trial_execution import ExecutionOptions, ProcessLimits
from engine.sweep.sweep_table import available_processors


@dataclass(frozen=True, kw_only=True)
class ClusterAddress:
    """The options that reach a cluster; without a scheduler there is none."""

    scheduler: str | None = None
    tls_ca_file: Path | None = None
    tls_cert: Path | None = None
    tls_key: Path | None = None


def execution_options(cluster: ClusterAddress, workers: int | None, limits: ProcessLimits) -> ExecutionOptions:
    """Return where and with which limits runs are executed.

    Raises:
        FlexcellError: options of both places are given.
    """
    if cluster.scheduler is None:
        if any(value is not None for value in asdict(cluster).values()):
            raise FlexcellError("certificates are for a cluster", where="--tls-cert", hint="give --scheduler too")
        return WorkerOptions(workers=workers or available_processors(), **asdict(limits))
    if workers is not None:
        raise FlexcellError(
            "--workers is of this machine, and --scheduler of others",
            where=cluster.scheduler,
            hint="a cluster executes as many runs at once as its workers have threads",
        )
    return ClusterOptions(
        scheduler=cluster.scheduler,
        tls_ca_file=cluster.tls_ca_file,
        tls_cert=cluster.tls_cert,
        tls_key=cluster.tls_key,
        **asdict(limits),
    )

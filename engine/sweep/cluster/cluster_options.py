"""Where a Dask cluster is and how it is reached; loads nothing of Dask."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from engine.errors import FlexcellError
from engine.sweep.subject import SweepSubject
from engine.sweep.trial_execution import ProcessLimits, TrialExecutor


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
        from engine.sweep.cluster.cluster_executor import ClusterExecutor

        return ClusterExecutor(subject, self)

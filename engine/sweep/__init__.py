"""Sweeps: a behavior executed many times with varied factors, and what that says about how often it succeeds.

`load_sweep(file)` of `engine.document.sweep` reads what is varied, `SweepSubject.load` everything that all runs have in
common, `configurations` the design. `execute_sweep` executes what is left in worker processes and saves each result;
`summarize` and `engine.sweep.report` tell what came out. `run_sweep` does it all, for scripts and notebooks. A worker
loads no statistics, so each name is imported with its first use.
"""

from engine.lazy_face import lazy_face

_HOMES = {
    "ClusterOptions": "engine.sweep.cluster.cluster_executor",
    "Comparison": "engine.sweep.verdict.comparison",
    "Configuration": "engine.sweep.design.configuration",
    "Shard": "engine.sweep.sweep_execution",
    "SweepEnd": "engine.sweep.sweep_execution",
    "SweepProgress": "engine.sweep.sweep_execution",
    "SweepResults": "engine.sweep.results",
    "SweepSubject": "engine.sweep.subject.sweep_subject",
    "SweepSummary": "engine.sweep.summary",
    "SweepTable": "engine.sweep.sweep_table",
    "TrialResult": "engine.sweep.execution.trial_result",
    "Trials": "engine.sweep.execution.trial",
    "WorkerOptions": "engine.sweep.execution.worker_pool",
    "compare_with_baseline": "engine.sweep.verdict.comparison",
    "configurations": "engine.sweep.design.designs",
    "execute_sweep": "engine.sweep.sweep_execution",
    "run_sweep": "engine.sweep.sweep_table",
    "saved_sweep": "engine.sweep.sweep_execution",
    "summarize": "engine.sweep.summary",
}

__all__ = list(_HOMES)  # pyright: ignore[reportUnsupportedDunderAll] - checkers read `__init__.pyi`
__getattr__ = lazy_face(__name__, _HOMES)

# The face of this room for type checkers; `tests/house/test_python_face.py` compares it with what is imported.

from engine.sweep.cluster.cluster_executor import ClusterOptions
from engine.sweep.design.configuration import Configuration
from engine.sweep.design.designs import configurations
from engine.sweep.execution.trial import Trials
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.execution.worker_pool import WorkerOptions
from engine.sweep.results import SweepResults
from engine.sweep.subject.sweep_subject import SweepSubject
from engine.sweep.summary import SweepSummary, summarize
from engine.sweep.sweep_execution import Shard, SweepEnd, SweepProgress, execute_sweep, saved_sweep
from engine.sweep.sweep_table import SweepTable, run_sweep
from engine.sweep.verdict.comparison import Comparison, compare_with_baseline

__all__ = [
    "ClusterOptions",
    "Comparison",
    "Configuration",
    "Shard",
    "SweepEnd",
    "SweepProgress",
    "SweepResults",
    "SweepSubject",
    "SweepSummary",
    "SweepTable",
    "TrialResult",
    "Trials",
    "WorkerOptions",
    "compare_with_baseline",
    "configurations",
    "execute_sweep",
    "run_sweep",
    "saved_sweep",
    "summarize",
]

"""Past runs of a project, from its journal and its recordings.

`Archive` lists them and opens one as an `ArchivedRun`: its events and its version of the behavior. `align_runs` pairs
the visits of two runs and finds where these first diverge, `compare_runs` tells all that differs, and `RunTrends` how
the last runs of a behavior went.
"""

from engine.archive.activation_intervals import ActivationInterval, ActivationIntervals
from engine.archive.archive import Archive, ArchivedRun
from engine.archive.past_runs import PastRun
from engine.archive.recording_files import RecordingFile
from engine.archive.run_alignment import AlignedVisit, Divergence, RunAlignment, Visit, align_runs
from engine.archive.run_comparison import RunComparison, compare_runs, is_different
from engine.archive.run_trend import RunTrend, RunTrends

__all__ = [
    "ActivationInterval",
    "ActivationIntervals",
    "AlignedVisit",
    "Archive",
    "ArchivedRun",
    "Divergence",
    "PastRun",
    "RecordingFile",
    "RunAlignment",
    "RunComparison",
    "RunTrend",
    "RunTrends",
    "Visit",
    "align_runs",
    "compare_runs",
    "is_different",
]

"""Past runs of a project, from its journal and its recordings.

`Archive` lists them and opens one as an `ArchivedRun`: its events and its version of the behavior. `align_runs` pairs
the visits of two runs and finds where these first diverge.
"""

from engine.archive.activation_intervals import ActivationInterval, ActivationIntervals
from engine.archive.archive import Archive, ArchivedRun
from engine.archive.past_runs import PastRun
from engine.archive.recording_files import RecordingFile
from engine.archive.run_alignment import AlignedVisit, Divergence, RunAlignment, Visit, align_runs

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
    "Visit",
    "align_runs",
]

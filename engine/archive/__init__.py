"""What is left of runs: those of the journal and the recordings of a project, to be looked at again.

`Archive` lists them and opens one as an `ArchivedRun`: its events and the behavior as it was then.
"""

from engine.archive.archive import Archive, ArchivedRun
from engine.archive.past_runs import PastRun
from engine.archive.recording_files import RecordingFile

__all__ = ["Archive", "ArchivedRun", "PastRun", "RecordingFile"]

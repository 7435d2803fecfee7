"""Past runs of a project, from its journal and its recordings.

`Archive` lists them and opens one as an `ArchivedRun`: its events and its version of the behavior.
"""

from engine.archive.archive import Archive, ArchivedRun
from engine.archive.past_runs import PastRun
from engine.archive.recording_files import RecordingFile

__all__ = ["Archive", "ArchivedRun", "PastRun", "RecordingFile"]

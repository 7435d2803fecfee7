"""Recordings of runs in MCAP files: written while a run goes on, opened in Foxglove, replayed in CI.

`RunRecording.open` begins one, `load_recording` reads one back. A recording is a viewer: whatever
happens to its file, the run goes on.
"""

from engine.recording.description import Description
from engine.recording.documents import Documents, collect_documents, recorded_behavior, recorded_substitutes
from engine.recording.finished_file import part_file, recovered_file
from engine.recording.recording import RecordedEvent, Recording, load_recording
from engine.recording.run_recording import DEFAULT_RATE_HZ, RecordingOrder, RunRecording

__all__ = [
    "DEFAULT_RATE_HZ",
    "Description",
    "Documents",
    "RecordedEvent",
    "Recording",
    "RecordingOrder",
    "RunRecording",
    "collect_documents",
    "load_recording",
    "part_file",
    "recorded_behavior",
    "recorded_substitutes",
    "recovered_file",
]

"""Recordings of runs in MCAP files: written during a run, opened in Foxglove, replayed in CI.

`RunRecording.open` starts one, `load_recording` reads one back. A recording is passive: an error of
its file never affects the run.
"""

from engine.recording.description import RecordingDescription
from engine.recording.finalization import part_file, recovered_file
from engine.recording.indexed_recording import IndexedRecording
from engine.recording.recorded_documents import (
    RecordedDocuments,
    collect_documents,
    recorded_behavior,
    recorded_substitutes,
)
from engine.recording.recorded_measures import recorded_measures
from engine.recording.recording import RecordedEvent, Recording, load_recording
from engine.recording.run_recording import DEFAULT_RATE_HZ, RecordingOptions, RunRecording

__all__ = [
    "DEFAULT_RATE_HZ",
    "IndexedRecording",
    "RecordedDocuments",
    "RecordedEvent",
    "Recording",
    "RecordingDescription",
    "RecordingOptions",
    "RunRecording",
    "collect_documents",
    "load_recording",
    "part_file",
    "recorded_behavior",
    "recorded_measures",
    "recorded_substitutes",
    "recovered_file",
]

"""What records the runs of a cell: one file given by its user here, a folder of files in `session_recordings`."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Protocol

from engine.bus import SkillBus
from engine.recording import RecordedDocuments, RecordingOptions, RunRecording
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions


@dataclass(frozen=True, kw_only=True)
class RunStartRecord:
    """How a run was started, for its replay."""

    documents: RecordedDocuments
    inputs: Mapping[str, object]
    supervision: RunOptions
    started_unix_s: float


class RunRecorder(Protocol):
    """Records runs."""

    def record(self, run: Run, bus: SkillBus, start: RunStartRecord) -> Callable[[], None]:
        """Record a run from its first event on; call the returned function when it has ended."""
        ...


class FileRecorder:
    """Records one run into a file that is open already."""

    def __init__(self, recording: RunRecording) -> None:
        self._recording = recording

    def record(self, run: Run, bus: SkillBus, start: RunStartRecord) -> Callable[[], None]:
        """Record a run from its first event on, until the file is closed: also how its cell comes to rest."""
        self._recording.attach(
            run, bus, started_unix_s=start.started_unix_s, inputs=start.inputs, supervision=start.supervision
        )
        return lambda: None


@asynccontextmanager
async def open_recorder(options: RecordingOptions | None, *, inline: bool) -> AsyncGenerator[RunRecorder | None]:
    """Open the file of a recording and complete it when the block ends; without options, nothing is recorded.

    Args:
        options: The file and what it keeps.
        inline: Write on the calling thread, as required on a virtual clock.

    Raises:
        RecordingError: the file cannot be created, or another process records into it.
    """
    if options is None:
        yield None
        return
    async with RunRecording.open(options, inline=inline) as recording:
        yield FileRecorder(recording)

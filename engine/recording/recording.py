"""A recording in memory: description of the run, documents, events with exact times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from mcap.records import Message

from engine.errors import JournalError, RecordingError
from engine.event import AnyEvent, RunEnded
from engine.journal import decode_event
from engine.recording.description import RECORD_NAME, RecordingDescription, from_metadata
from engine.recording.event_digests import DIGESTS_NAME, altered_events
from engine.recording.file_content import FileContent, read_content
from engine.recording.finalization import EVENT_TOPIC, PART, part_file
from engine.recording.recorded_documents import RecordedDocuments


@dataclass(frozen=True, slots=True)
class RecordedEvent:
    """One event with its time, finer than its own `time_s`, which is rounded."""

    event: AnyEvent
    at_s: float


@dataclass(frozen=True, kw_only=True)
class Recording:
    """One recorded run."""

    path: Path
    description: RecordingDescription
    documents: RecordedDocuments
    events: tuple[RecordedEvent, ...]
    resolution_s: float = 1e-9
    """Resolution of `at_s`."""
    altered: Mapping[int, str] | None = None
    """The recorded digests of events that were altered since, by index; None where there are no digests to tell.

    Killed processes leave none, earlier versions and journals neither.
    """

    @property
    def complete(self) -> bool:
        """Whether it contains the end of the run; otherwise its process was killed, or the disk was full."""
        return bool(self.events) and isinstance(self.events[-1].event, RunEnded)


def load_recording(path: Path) -> Recording:
    """Read a recording. For a killed process, `<path>.part` is read up to its last complete record.

    Raises:
        RecordingError: it cannot be read, is damaged, or is no recording of a run.
    """
    left = part_file(path)
    file = left if not path.exists() and left.exists() else path
    content = read_content(file, EVENT_TOPIC)
    if not content.complete and file.suffix != PART:
        raise RecordingError(
            "this file is truncated", where=file, hint=f"rename it to *{PART} to use its complete records"
        )
    if RECORD_NAME not in content.metadata:
        raise RecordingError("this is not a recording of a run", where=file, hint="give a file that --record wrote")
    description = from_metadata(content.metadata[RECORD_NAME], where=file)
    documents = RecordedDocuments(
        behavior=description.behavior_file, cell=description.cell_file, texts=dict(content.attachments)
    )
    events = tuple(_events(content, file))
    if content.complete and not events:
        raise RecordingError(
            "the events of the run are missing", where=file, hint="it is damaged; record the run again"
        )
    return Recording(
        path=file,
        description=description,
        documents=documents,
        events=events,
        altered=altered_events(content.metadata.get(DIGESTS_NAME), [message.data for message in content.messages]),
    )


def _events(content: FileContent, file: Path) -> Iterator[RecordedEvent]:
    zero_ns: int | None = None
    for message in content.messages:
        event = _event(message, file)
        if zero_ns is None:
            zero_ns = message.log_time - round(event.time_s * 1e9)
        yield RecordedEvent(event, (message.log_time - zero_ns) / 1e9)


def _event(message: Message, file: Path) -> AnyEvent:
    try:
        return decode_event(message.data)
    except JournalError as error:
        raise RecordingError(error.message, where=file, hint="it is damaged or of another version") from error

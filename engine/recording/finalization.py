"""Converts a live recording to a finalized one: compressed chunks with an index, events in separate chunks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from mcap.records import Attachment, Channel, McapRecord, Message, Metadata, Schema
from mcap.writer import CompressionType, Writer

from engine.errors import RecordingError
from engine.host.private_files import open_private
from engine.recording.file_content import open_records
from engine.recording.live_file import PROFILE
from engine.recording.read_budget import ReadBudget

EVENT_TOPIC = "/flexcell/events"
CHUNK_BYTES = 512 * 1024
PART = ".part"


def part_file(path: Path) -> Path:
    """Return the path of a recording while it is written."""
    return path.with_name(path.name + PART)


def recovered_file(path: Path) -> Path:
    """Return the path for the recovered recording of a killed process: `run.mcap` → `run-recovered.mcap`."""
    return path.with_name(f"{path.stem}-recovered{path.suffix}")


def finalize_recording(part: Path, target: Path) -> None:
    """Write `target` from a live recording, closed or truncated, and delete the live recording.

    Raises:
        RecordingError: a file cannot be read or written; the live recording is unchanged.
    """
    fresh = target.with_name(f".{target.name}.new")
    try:
        with open_records(part) as records, open_private(fresh) as stream:
            writer = Writer(stream, chunk_size=CHUNK_BYTES, compression=CompressionType.ZSTD, enable_data_crcs=True)
            _copy(records, writer, ReadBudget(part.stat().st_size))
        fresh.replace(target)
        part.unlink()
    except OSError as error:
        fresh.unlink(missing_ok=True)
        reason = error.strerror or str(error)
        raise RecordingError(
            f"the recording cannot be finalized: {reason}", where=target, hint=f"{part.name} is complete"
        ) from error
    except Exception as error:
        # A damaged file may cause any parser error; the file is left unchanged.
        fresh.unlink(missing_ok=True)
        what = " ".join(str(error).split()) or type(error).__name__
        raise RecordingError(f"this file is damaged: {what}", where=part, hint="remove it") from error


def _copy(records: Callable[[], Iterator[McapRecord]], writer: Writer, allowance: ReadBudget) -> None:
    writer.start(profile=PROFILE, library="flexcell")
    schemas: dict[int, int] = {}
    channels: dict[int, int] = {}
    events: set[int] = set()
    for record in records():
        match record:
            case Metadata():
                allowance.take_document(sum(len(key) + len(value) for key, value in record.metadata.items()))
                writer.add_metadata(record.name, record.metadata)
            case Attachment():
                allowance.take_document(len(record.data))
                writer.add_attachment(record.create_time, record.log_time, record.name, record.media_type, record.data)
            case Schema() if record.id not in schemas:
                schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
            case Channel() if record.id not in channels:
                channels[record.id] = writer.register_channel(
                    record.topic, record.message_encoding, schemas[record.schema_id], record.metadata
                )
                if record.topic == EVENT_TOPIC:
                    events.add(record.id)
            case Message():
                if record.channel_id in events:
                    _write(record, channels, writer)
            case _:
                pass
    writer.flush()
    for record in records():
        if isinstance(record, Message) and record.channel_id not in events:
            _write(record, channels, writer)
    writer.finish()


def _write(message: Message, channels: dict[int, int], writer: Writer) -> None:
    writer.add_message(
        channels[message.channel_id], message.log_time, message.data, message.publish_time, message.sequence
    )

"""Alters the events of a recording the way an editor of MCAP files would: with valid checksums, all else kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from mcap.records import Attachment, Channel, Message, Metadata, Schema
from mcap.writer import Writer

from engine.recording.file_content import open_records
from engine.recording.finalization import EVENT_TOPIC


def alter_events(source: Path, target: Path, alter: Callable[[bytes], bytes | None]) -> Path:
    """Copy a recording; what `alter` returns replaces an event, None drops it."""
    schemas: dict[int, int] = {}
    channels: dict[int, int] = {}
    events: set[int] = set()
    with open_records(source) as records, target.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        for record in records():
            match record:
                case Metadata():
                    writer.add_metadata(record.name, record.metadata)
                case Attachment():
                    writer.add_attachment(0, 0, record.name, record.media_type, record.data)
                case Schema() if record.id not in schemas:
                    schemas[record.id] = writer.register_schema(record.name, record.encoding, record.data)
                case Channel() if record.id not in channels:
                    channels[record.id] = writer.register_channel(
                        record.topic, record.message_encoding, schemas[record.schema_id], record.metadata
                    )
                    if record.topic == EVENT_TOPIC:
                        events.add(record.id)
                case Message():
                    data = alter(record.data) if record.channel_id in events else record.data
                    if data is not None:
                        channel, at_ns = channels[record.channel_id], record.log_time
                        writer.add_message(channel, at_ns, data, record.publish_time, record.sequence)
                case _:
                    pass
        writer.finish()
    return target

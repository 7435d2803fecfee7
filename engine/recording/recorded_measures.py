"""Measures of a recorded run, from the topics in its file: a recording has no world that could sum them up."""

from __future__ import annotations

from pathlib import Path

import msgspec
from mcap.records import Channel, Message

from engine.measures import TopicMeasures
from engine.messages import Message as BusMessage
from engine.recording.file_content import damage_reported, open_records


def recorded_measures(path: Path) -> dict[str, float]:
    """Return the measures of the arms in a recording, as far as its topics tell, by name.

    Raises:
        RecordingError: it cannot be read, or is damaged.
    """
    measures = TopicMeasures()
    channels: dict[int, tuple[str, type[BusMessage]]] = {}
    with damage_reported(path), open_records(path) as records:
        for record in records():
            if isinstance(record, Channel):
                topic = record.topic.removeprefix("/")
                kind = measures.kind(topic)
                if kind is not None:
                    channels[record.id] = (topic, kind)
            elif isinstance(record, Message) and record.channel_id in channels:
                topic, kind = channels[record.channel_id]
                try:
                    message = msgspec.json.decode(record.data, type=kind)
                except msgspec.DecodeError:
                    continue  # of another device, or written by another version
                measures.take(topic, message)
    return measures.measures()

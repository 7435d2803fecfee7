"""Recordings of a run that never was: what the topics are to have said, and when."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import msgspec

from engine.event import AnyEvent, RunStarted
from engine.journal import encode_event
from engine.messages import Message
from engine.recording import part_file
from engine.recording.channel_schema import channel_schema
from engine.recording.finalization import EVENT_TOPIC, finalize_recording
from engine.recording.live_file import LiveFile

RecordedMessages = Mapping[str, Sequence[tuple[float, Message]]]
"""By topic: at which time of the run it said what."""


def write_recording(path: Path, said: RecordedMessages, *, finished: bool = True, since_s: float = 0.0) -> Path:
    """Write it, as a run since `since_s` does that began at 1000 s of the file's clock; return the file."""
    live = LiveFile.open(part_file(path), inline=True)
    channel = live.channel(EVENT_TOPIC, "flexcell.Event", channel_schema(AnyEvent, title="flexcell.Event"), metadata={})
    first = RunStarted(seq=1, time_s=since_s, behavior="b", document="", parameters={}, seed=0, clock="real")
    live.write(channel, _ns(since_s), encode_event(first))
    for topic, messages in said.items():
        kind = type(messages[0][1])
        schema = channel_schema(kind, title=f"flexcell.{kind.__name__}")
        number = live.channel(f"/{topic}", f"flexcell.{kind.__name__}", schema, metadata={})
        for at_s, message in messages:
            live.write(number, _ns(at_s), msgspec.json.encode(message))
    live.close()
    if not finished:
        return part_file(path)
    finalize_recording(part_file(path), path)
    return path


def _ns(time_s: float) -> int:
    return round((1000.0 + time_s) * 1e9)

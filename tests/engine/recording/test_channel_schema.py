"""Schemas of channels: what Foxglove reads, and what every message fits."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import msgspec
import pytest

from engine import messages
from engine.errors import Cause
from engine.event import AnyEvent, MessageReceived, NodeExited, RunEnded
from engine.journal import encode_event
from engine.recording.channel_schema import channel_schema
from engine.recording.foxglove_scene import FoxgloveSceneUpdate
from engine.recording.foxglove_views import FoxgloveFrameTransforms, FoxgloveJointStates, FoxgloveLog
from tests.engine.recording.foxglove_rules import complaints

MESSAGES = [each for each in vars(messages).values() if isinstance(each, type) and issubclass(each, messages.Message)]


class Inner(msgspec.Struct):
    """A message in a message."""

    number: int
    raw: bytes


class Outer(msgspec.Struct):
    """Fields of every sort."""

    text: str
    inner: Inner
    several: list[Inner]
    vector: tuple[float, float, float]
    nested: list[list[float]]
    mixed: tuple[float, str]
    maybe: int | None
    free: dict[str, object]


def _schema(kind: Any) -> dict[str, Any]:
    return json.loads(channel_schema(kind, title="t"))


@pytest.mark.parametrize(
    "kind",
    [*MESSAGES, AnyEvent, FoxgloveFrameTransforms, FoxgloveJointStates, FoxgloveSceneUpdate, FoxgloveLog],
    ids=str,
)
def test_foxglove_reads_every_schema(kind: Any) -> None:
    assert list(complaints(_schema(kind))) == []


def test_fields_keep_their_types_and_what_is_no_plain_type_is_left_out() -> None:
    inner = {
        "type": "object",
        "properties": {"number": {"type": "integer"}, "raw": {"type": "string", "contentEncoding": "base64"}},
        "required": ["number", "raw"],
    }
    assert _schema(Outer)["properties"] == {
        "text": {"type": "string"},
        "inner": inner,
        "several": {"type": "array", "items": inner},
        "vector": {"type": "array", "items": {"type": "number"}},
        "free": {"type": "object", "properties": {}, "required": []},
    }


def test_a_union_has_what_its_members_agree_on() -> None:
    schema = _schema(AnyEvent)
    assert {"event", "seq", "time_s"} <= set(schema["required"])
    assert schema["properties"]["path"] == {"type": "string"}
    assert "message" not in schema["properties"]


@pytest.mark.parametrize(
    "event",
    [
        NodeExited(
            seq=1, time_s=0.5, path="root", visit=1, outcome="a", cause=Cause(message="m", because=Cause(message="n"))
        ),
        MessageReceived(seq=2, time_s=0.5, path="root", topic="t", message={"a": [1, None]}),
        RunEnded(seq=3, time_s=0.5, status="stopped"),
    ],
    ids=lambda event: type(event).__name__,
)
def test_events_fit_the_schema_of_their_channel(event: Any) -> None:
    jsonschema.validate(json.loads(encode_event(event)), _schema(AnyEvent))

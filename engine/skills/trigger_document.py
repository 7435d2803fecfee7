"""The file in which the Helping Hand keeps its triggers, answered under `teach` (RCY 7.1)."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message
from engine.skill import Service
from engine.skills.teaching import TeachStatus


class TriggerDocument(Message, frozen=True, kw_only=True):
    """The YAML text of the triggers and the file it is kept in, empty where they live only as long as the server."""

    file: str
    text: str


class ReadTriggerDocument(Service[TriggerDocument], frozen=True, kw_only=True):
    """Return the triggers as they are written."""


class WriteTriggerDocument(Service[TeachStatus], frozen=True, kw_only=True):
    """Write the triggers as `text` and listen to them; refused, with line and column, where it is no such document."""

    text: Annotated[str, msgspec.Meta(max_length=200_000)]

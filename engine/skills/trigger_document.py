"""The trigger document of the Helping Hand, served under `teach` (RCY 7.1)."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message
from engine.skill import Service
from engine.skills.teaching import TeachStatus


class TriggerDocument(Message, frozen=True, kw_only=True):
    """The YAML text of the triggers and its file, empty when they are kept only while the server runs."""

    file: str
    text: str


class ReadTriggerDocument(Service[TriggerDocument], frozen=True, kw_only=True):
    """Return the trigger document."""


class WriteTriggerDocument(Service[TeachStatus], frozen=True, kw_only=True):
    """Write the trigger document `text` and use its triggers; an invalid one is refused with line and column."""

    text: Annotated[str, msgspec.Meta(max_length=200_000)]

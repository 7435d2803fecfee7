"""The message of the topics that a cell document declares."""

from __future__ import annotations

from engine.messages.geometry import Message


class TopicValue(Message, frozen=True, kw_only=True):
    """A value, of the type that the cell document gives for the topic."""

    value: object

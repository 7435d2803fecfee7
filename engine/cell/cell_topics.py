"""Opens the topics that a cell document declares."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.document.cell import CellDocument
from engine.document.parameter_spec import ParameterSpec
from engine.messages.topic_value import TopicValue


def open_topics(bus: SkillBus, document: CellDocument) -> None:
    """Open each declared topic to everybody, with its default as the first message."""
    for name, spec in document.topics.items():
        topic = bus.topic(name, TopicValue)
        topic.open_to_all(lambda message, spec=spec: _problem(spec, message))
        if not spec.required:
            topic.publish(TopicValue(value=spec.default))


def _problem(spec: ParameterSpec, message: TopicValue) -> str | None:
    problem = spec.problem(message.value)
    return None if problem is None else f"the value does not fit the topic: {problem}"

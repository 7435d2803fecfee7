"""Messages for the bus page: the list of the bus, forms, numeric fields, and the progress of a goal."""

from __future__ import annotations

from typing import Any

import msgspec

from editor_web.http_bodies.common_bodies import Name, RequestBody
from editor_web.telemetry.plot_signals import SignalField
from engine.bus import GoalEnd
from engine.project import ParameterInfo, SkillInfo, TopicInfo


class BusListing(msgspec.Struct, frozen=True, kw_only=True):
    """All topics, skills and parameters of the bus, without metrics."""

    shape: str
    topics: tuple[TopicInfo, ...]
    skills: tuple[SkillInfo, ...]
    parameters: tuple[ParameterInfo, ...]


class BusForm(msgspec.Struct, frozen=True, kw_only=True):
    """The JSON Schema of a request or message."""

    name: str
    schema: dict[str, Any]


class TopicFields(msgspec.Struct, frozen=True, kw_only=True):
    """The numeric fields of one topic."""

    topic: str
    type: str
    fields: tuple[SignalField, ...]


class BusFields(msgspec.Struct, frozen=True, kw_only=True):
    """The numeric fields of all topics."""

    topics: tuple[TopicFields, ...]


class GoalSentLine(msgspec.Struct, frozen=True, kw_only=True, tag="sent", tag_field="k"):
    """First line: the goal's id, for its cancellation."""

    goal: str


class GoalProgressLine(msgspec.Struct, frozen=True, kw_only=True, tag="course", tag_field="k"):
    """Status and latest feedback of the goal; at most five lines per second."""

    status: str
    feedback: object = None


class GoalEndLine(msgspec.Struct, frozen=True, kw_only=True, tag="end", tag_field="k"):
    """Last line: the end of the goal; the device is at rest."""

    end: GoalEnd[object]


GoalStreamLine = GoalSentLine | GoalProgressLine | GoalEndLine


class BusParameterBody(RequestBody, frozen=True, kw_only=True):
    """A new value of a parameter."""

    name: Name
    value: object

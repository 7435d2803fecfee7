"""Requests and messages as plain data, for callers that know an address but not its type."""

from __future__ import annotations

from typing import Any, cast

import msgspec

from engine.bus.bus import SkillBus
from engine.errors import BusError
from engine.messages.topic_value import TopicValue
from engine.skill import Action, Service
from engine.wording.misfit import explain_misfit


def typed_service(bus: SkillBus, address: str, fields: object) -> Service[Any]:
    """Return the request of the service at an address.

    Raises:
        NoSuchSkill: nothing is served there.
        BusError: it is an action, or the fields are not those of the request.
    """
    request = _typed(bus, address, fields)
    if not isinstance(request, Service):
        raise BusError("this is an action, not a service", where=address, hint="send it a goal")
    return cast("Service[Any]", request)


def typed_action(bus: SkillBus, address: str, fields: object) -> Action[Any, Any]:
    """Return the goal of the action at an address.

    Raises:
        NoSuchSkill: nothing is served there.
        BusError: it is a service, or the fields are not those of the goal.
    """
    goal = _typed(bus, address, fields)
    if not isinstance(goal, Action):
        raise BusError("this is a service, not an action", where=address, hint="call it")
    return cast("Action[Any, Any]", goal)


def publish_command(bus: SkillBus, topic: str, message: object) -> None:
    """Publish plain data on a topic that takes commands.

    Raises:
        BusError: there is no such topic, it takes no commands, or the message is invalid.
    """
    target = bus.find_topic(topic)
    if not target.takes_commands:
        names = ", ".join(bus.command_topics())
        hint = f"commands are taken on {names}" if names else "no topic of this bus takes commands"
        raise BusError("this topic takes no commands", where=topic, hint=hint)
    try:
        typed = msgspec.convert(message, target.kind)
    except msgspec.ValidationError as error:
        what = explain_misfit(error, target.kind)
        raise BusError(f"this is not a {target.kind.__name__}: {what}", where=topic) from error
    target.publish(typed)


def publish_value(bus: SkillBus, topic: str, value: object) -> None:
    """Publish a value on a topic that the cell document declares; the command topics of devices are refused.

    Raises:
        BusError: there is no such topic, it is one of a device, or the value is not of its type.
    """
    target = bus.find_topic(topic)
    if target.kind is not TopicValue:
        raise BusError(
            f"a behavior cannot publish on a topic of {target.kind.__name__}",
            where=topic,
            hint="declare a topic under `topics` of the cell; a device is commanded by its services and actions",
        )
    target.publish(TopicValue(value=value))


def _typed(bus: SkillBus, address: str, fields: object) -> object:
    skill = bus.request_type(address)
    try:
        return msgspec.convert(fields, skill)
    except msgspec.ValidationError as error:
        raise BusError(f"this is not a {skill.__name__}: {explain_misfit(error, skill)}", where=address) from error

"""What a replay must reproduce of an event."""

from __future__ import annotations

import re
from typing import Any, cast

import msgspec

from engine.event import BehaviorChanged, Event, MessageLogged, RunStarted
from engine.journal import encode_event

_FILE_PLACE = re.compile(r"[^\s'\"`,;()]*\.(?:py|ya?ml|json):\d+(?::\d+)?(?:: )?")


def plain_event(event: Event) -> dict[str, Any]:
    """Return the part of an event that a replay must reproduce: all but numbers, times, and file positions.

    Files move and lines shift without any change of what happens.
    """
    plain: dict[str, Any] = msgspec.json.decode(encode_event(event))
    del plain["seq"], plain["time_s"]
    if isinstance(event, RunStarted):
        del plain["document"], plain["clock"]
    if isinstance(event, BehaviorChanged):
        del plain["document"]
    if isinstance(event, MessageLogged):
        plain["message"] = _without_places(event.message)
    if "cause" in plain:
        plain["cause"] = _without_places(plain["cause"])
    return plain


def _without_places(value: Any) -> Any:
    if isinstance(value, str):
        return _FILE_PLACE.sub("", value)
    if isinstance(value, dict):
        clean = {key: _without_places(each) for key, each in cast("dict[str, Any]", value).items()}
        return {key: each for key, each in clean.items() if each != ""}
    if isinstance(value, list):
        return [_without_places(each) for each in cast("list[Any]", value)]
    return value

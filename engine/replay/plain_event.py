"""What a replay must reproduce of an event, and the differences between two events."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import chain
from typing import Any, cast

import msgspec

from engine.event import BehaviorChanged, Event, MessageLogged, RunStarted
from engine.journal import encode_event

_LONGEST = 60
_FILE_PLACE = re.compile(r"[^\s'\"`,;()]*\.(?:py|ya?ml|json):\d+(?::\d+)?(?:: )?")
_MISSING = object()


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


def value_changes(recorded: object, replayed: object, at: str = "") -> Iterable[str]:
    """Iterate over the differing values, each as `speed: 0.5 ≠ 0.7`."""
    if isinstance(recorded, dict) and isinstance(replayed, dict):
        before, after = cast("dict[str, object]", recorded), cast("dict[str, object]", replayed)
        for key in chain(before, (key for key in after if key not in before)):
            yield from value_changes(before.get(key, _MISSING), after.get(key, _MISSING), f"{at}.{key}" if at else key)
        return
    if isinstance(recorded, list) and isinstance(replayed, list):
        earlier, later = cast("list[object]", recorded), cast("list[object]", replayed)
        if len(earlier) == len(later):
            for index, pair in enumerate(zip(earlier, later, strict=True)):
                yield from value_changes(*pair, f"{at}[{index}]")
            return
    if recorded != replayed:
        yield f"{at}: {_short(cast('object', recorded))} ≠ {_short(cast('object', replayed))}"


def _without_places(value: Any) -> Any:
    if isinstance(value, str):
        return _FILE_PLACE.sub("", value)
    if isinstance(value, dict):
        clean = {key: _without_places(each) for key, each in cast("dict[str, Any]", value).items()}
        return {key: each for key, each in clean.items() if each != ""}
    if isinstance(value, list):
        return [_without_places(each) for each in cast("list[Any]", value)]
    return value


def _short(value: object) -> str:
    if value is _MISSING:
        return "nothing"
    text = msgspec.json.encode(value).decode()
    return text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…"

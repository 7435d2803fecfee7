"""Requests of recordings that were made before their skill had all of its fields."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec

from engine.event import GoalSent, ServiceCalled
from engine.runtime.record.nonfinite import decode_nonfinite, encode_nonfinite
from engine.skill import Skill


def with_all_fields(recorded: GoalSent | ServiceCalled) -> GoalSent | ServiceCalled:
    """Return a recorded request with those fields that its skill has since been given, at their defaults.

    The request itself where no skill of its name has its fields.
    """
    name = recorded.address.rpartition("/")[2]
    for kind in _kinds(Skill):
        if kind.skill_name() != name:
            continue
        try:
            request = msgspec.convert(decode_nonfinite(recorded.request), kind, str_keys=True)
        except msgspec.ValidationError:
            continue
        return msgspec.structs.replace(recorded, request=encode_nonfinite(request.data()))
    return recorded


def _kinds(kind: type[Skill[Any]]) -> Iterator[type[Skill[Any]]]:
    for each in kind.__subclasses__():
        yield each
        yield from _kinds(each)

"""Detects edges of a button in the messages of a topic: pressed, released, or no change."""

from __future__ import annotations

from enum import Enum
from typing import Any

import msgspec

from engine.errors import BusError

_USUAL = ("value", "data", "pressed", "held", "on")


class ButtonEdge(Enum):
    """A change of a button."""

    PRESSED = "pressed"
    RELEASED = "released"


class EdgeDetector:
    """Compares a field of each message with a value; before the first message the two differ.

    Args:
        kind: The type of the messages.
        field: Its field; where it is empty, one of the usual names, or the only boolean field.
        value: The value that means pressed.

    Raises:
        BusError: the messages have no such field.
    """

    def __init__(self, kind: type[Any], *, field: str, value: bool | float | str) -> None:
        self._field = _field_of(kind, field)
        self._value = value
        self.pressed = False

    def take(self, message: object) -> ButtonEdge | None:
        """Return the change by this message; None if there is none."""
        value = getattr(message, self._field)
        # True == 1 in Python, but a button value 1 is different from True.
        pressed = value == self._value and isinstance(value, bool) == isinstance(self._value, bool)
        if pressed == self.pressed:
            return None
        self.pressed = pressed
        return ButtonEdge.PRESSED if pressed else ButtonEdge.RELEASED


def _field_of(kind: type[Any], field: str) -> str:
    fields = {one.name: one.type for one in msgspec.structs.fields(kind)}
    if field:
        if field not in fields:
            raise BusError(f"{kind.__name__} has no field {field}", hint=f"it has {', '.join(fields)}")
        return field
    for name in _USUAL:
        if name in fields:
            return name
    booleans = [name for name, type_ in fields.items() if type_ is bool]
    if len(booleans) != 1:
        raise BusError(
            f"{kind.__name__} has {len(booleans)} boolean fields", hint=f"name one as `field`: {', '.join(fields)}"
        )
    return booleans[0]

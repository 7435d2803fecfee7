"""Buttons of a Linux input device, such as a Bluetooth media controller, read from its event file.

The kernel writes `struct input_event` of 64-bit machines: two longs of time, type, code, value
(`linux/input.h`); keys are type 1 with value 0 (up), 1 (down) or 2 (repeated while held).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

_EVENT = struct.Struct("llHHi")
_KEY = 1
_UP, _REPEATED = 0, 2

BUTTON_NAMES = {
    28: "enter",
    57: "space",
    103: "up",
    105: "left",
    106: "right",
    108: "down",
    113: "mute",
    114: "volume_down",
    115: "volume_up",
    163: "next",
    164: "play_pause",
    165: "previous",
    166: "stop",
    200: "play",
    201: "pause",
    208: "fast_forward",
    168: "rewind",
}
"""The usual names of key codes (`linux/input-event-codes.h`); others are called `key_<code>`."""


@dataclass(frozen=True, kw_only=True)
class ButtonEvent:
    """A button went down (`pressed`) or up."""

    button: str
    pressed: bool


class EventReader:
    """Decodes bytes, in chunks of any size, to button events: one event per change of a button.

    Events of other types and repeats of a held key are ignored.
    """

    def __init__(self) -> None:
        self._left = b""
        self._down: dict[str, None] = {}

    def feed(self, data: bytes) -> Iterator[ButtonEvent]:
        """Yield the events in these bytes."""
        data = self._left + data
        whole = len(data) // _EVENT.size * _EVENT.size
        self._left = data[whole:]
        for _, _, kind, code, value in _EVENT.iter_unpack(data[:whole]):
            if kind != _KEY or value == _REPEATED:
                continue
            button = BUTTON_NAMES.get(code, f"key_{code}")
            pressed = value != _UP
            if pressed == (button in self._down):
                continue
            if pressed:
                self._down[button] = None
            else:
                del self._down[button]
            yield ButtonEvent(button=button, pressed=pressed)

    def release(self) -> Iterator[ButtonEvent]:
        """Yield the release of every pressed button: a removed device has no pressed buttons."""
        for button in tuple(self._down):
            del self._down[button]
            yield ButtonEvent(button=button, pressed=False)

"""The pins behind an emulated pigpiod, and its protocol: 16 bytes a request, `<IIII` command, p1, p2, p3.

A reply has the first three and an `int32` result, which is negative for an error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from struct import Struct

_REQUEST = Struct("<IIII")
_REPLY = Struct("<IIIi")
PINS = 54
_BAD_GPIO, _BAD_LEVEL, _UNKNOWN_COMMAND, _NO_PWM = -3, -5, -88, -92
_OUTPUT = 1
_HARDWARE_PI_3B = 0xA02082
_DAEMON_VERSION = 79


@dataclass
class EmulatedPin:
    """One pin: `mode` 0 is input, 1 output; `duty` is None without PWM; `changed_s` is when its level changed last."""

    mode: int = 0
    level: int = 0
    duty: int | None = None
    span: int = 255
    frequency_hz: int = 800
    changed_s: float = 0.0


class EmulatedPins:
    """All pins of one computer; they keep their values when clients come and go.

    Args:
        now_s: The clock of `changed_s`.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self.pins = [EmulatedPin() for _ in range(PINS)]
        self._now_s = now_s
        self._handles = 0

    def set_level(self, number: int, level: int) -> None:
        """Set the level of a pin, as a client does, or what is connected to it."""
        pin = self.pins[number]
        if pin.level != level or pin.duty is not None:
            pin.level, pin.duty, pin.changed_s = level, None, self._now_s()

    def execute(self, command: int, first: int, second: int) -> int:
        """Execute a request and return its result."""
        match command:
            case 10:  # BR1: the levels of the first 32 pins
                levels = sum(pin.level << number for number, pin in enumerate(self.pins[:32]))
                return levels - (1 << 32) if levels >= 1 << 31 else levels
            case 16:  # TICK
                return int(self._now_s() * 1e6) & 0x7FFFFFFF
            case 17:
                return _HARDWARE_PI_3B
            case 26:
                return _DAEMON_VERSION
            case 99:  # NOIB: a handle for notifications, of which this one sends none
                self._handles += 1
                return self._handles - 1
            case 19 | 21:
                return 0
            case 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7 | 22 | 23 | 83 | 97:
                return self._of_pin(command, first, second) if first < PINS else _BAD_GPIO
            case _:
                return _UNKNOWN_COMMAND

    def _of_pin(self, command: int, number: int, value: int) -> int:
        pin = self.pins[number]
        match command:
            case 0:  # MODES
                pin.mode = value
            case 1:
                return pin.mode
            case 3:
                return pin.level
            case 4:  # WRITE makes it an output
                if value > 1:
                    return _BAD_LEVEL
                pin.mode = _OUTPUT
                self.set_level(number, value)
            case 5:  # PWM
                pin.mode = _OUTPUT
                pin.duty, pin.changed_s = value, self._now_s()
                pin.level = int(value > 0)
            case 6:
                pin.span = value
                return value
            case 7:
                pin.frequency_hz = value
                return value
            case 22:
                return pin.span
            case 23:
                return pin.frequency_hz
            case 83:
                return _NO_PWM if pin.duty is None else pin.duty
            case _:  # pulls and glitch filters change nothing here
                pass
        return 0


class PigpioSession:
    """Implements `ProtocolSession` for one client."""

    def __init__(self, pins: EmulatedPins, refuses: Callable[[], bool]) -> None:
        self._pins = pins
        self._refuses = refuses
        self._waiting = bytearray()

    def feed(self, received: bytes) -> bytes:
        """Answer complete requests."""
        self._waiting += received
        replies = bytearray()
        while len(self._waiting) >= _REQUEST.size:
            command, first, second, _more = _REQUEST.unpack_from(self._waiting)
            del self._waiting[: _REQUEST.size]
            result = _UNKNOWN_COMMAND if self._refuses() else self._pins.execute(command, first, second)
            replies += _REPLY.pack(command, first, second, result)
        return bytes(replies)

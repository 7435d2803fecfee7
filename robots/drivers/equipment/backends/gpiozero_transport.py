"""Pins of a Raspberry Pi through gpiozero: a mock, a pigpiod over the network, or lgpio on this computer.

The pins of the factory are used, not gpiozero's devices: these turn outputs into inputs when they are closed, and an
output that holds a clamp would let it go.
"""

from __future__ import annotations

import socket
import struct
from contextlib import suppress
from typing import Any

from engine.document.equipment import DigitalInputPin, EquipmentDocument, GpiozeroPins, Pin, PwmPin
from robots.drivers.equipment.backends.pin_values import PinCommand, PinReading, PinValue
from robots.io.wire.link_error import LinkError

_PULLS = {"none": "floating", "up": "up", "down": "down"}
_CONNECT_S = 0.3
_HARDWARE = 17
_REQUEST = struct.Struct("<IIII")
_REPLY = struct.Struct("<IIIi")


class GpiozeroTransport:
    """Implements `DeviceTransport` by gpiozero."""

    def __init__(self, document: EquipmentDocument, backend: GpiozeroPins) -> None:
        self._document = document
        self._backend = backend
        self._factory: Any = None
        self._pins: dict[str, Any] = {}
        self._revision = 0
        """What pigpiod answers to a question with a known answer: pigpio does not check what answers belong to."""

    @property
    def address(self) -> str:
        """Host and port of pigpiod, or what is on this computer."""
        backend = self._backend
        return f"{backend.host}:{backend.port}" if backend.factory == "pigpio" else f"{backend.factory} pins"

    @property
    def remedy(self) -> str:
        """What to check when the pins are not reached."""
        if self._backend.factory == "pigpio":
            return "check that pigpiod runs there and takes connections of this computer"
        return "check that this computer has GPIO pins and that you may use them (group gpio)"

    def open(self) -> None:
        """Reach the pins; outputs get their safe values."""
        try:
            self._factory = self._new_factory()
            self._pins = {name: self._prepared(name, pin) for name, pin in self._document.pins.items()}
        except Exception as error:
            self.close()
            raise LinkError(f"cannot reach the pins: {_words(error)}") from error

    def close(self) -> None:
        """Disconnect; the pins keep their function and value."""
        factory, self._factory, self._pins = self._factory, None, {}
        if factory is not None and self._backend.factory == "pigpio":
            _disconnect(factory)

    def read(self) -> PinReading:
        """Read all pins."""
        try:
            values = {name: self._value(name, pin) for name, pin in self._opened().items()}
            if self._revision and self._factory.connection.get_hardware_revision() != self._revision:
                raise LinkError("what answers is not pigpiod any more")
            return PinReading(values=values)
        except Exception as error:
            raise LinkError(f"no valid answer: {_words(error)}") from error

    def write(self, command: PinCommand) -> None:
        """Set outputs, one after the other."""
        pins = self._opened()
        try:
            for name, value in command.values.items():
                spec, level = self._document.pins[name], self._level(name, value)
                pins[name].state = level if isinstance(spec, PwmPin) else int(level)
        except Exception as error:
            raise LinkError(f"the pins were not set: {_words(error)}") from error

    def _opened(self) -> dict[str, Any]:
        if not self._pins:
            raise LinkError("not connected")
        return self._pins

    def _value(self, name: str, pin: Any) -> PinValue:
        spec, level = self._document.pins[name], float(pin.state)
        value = 1.0 - level if spec.active_low else level
        return round(value, 4) if isinstance(spec, PwmPin) else value > 0.5

    def _level(self, name: str, value: PinValue) -> float:
        return 1.0 - float(value) if self._document.pins[name].active_low else float(value)

    def _prepared(self, name: str, spec: Pin) -> Any:
        """Return a pin as the document has it; an output is at its safe value at once."""
        pin = self._factory.pin(spec.pin)
        if isinstance(spec, DigitalInputPin):
            pin.input_with_pull(_PULLS[spec.pull])
            return pin
        level = self._level(name, spec.safe)
        pin.output_with_state(int(level >= 1.0))
        if isinstance(spec, PwmPin):
            pin.frequency = spec.frequency_hz
            pin.state = level
        return pin

    def _new_factory(self) -> Any:
        backend = self._backend
        if backend.factory == "mock":
            from gpiozero.pins.mock import MockFactory, MockPWMPin

            return MockFactory(pin_class=MockPWMPin)
        if backend.factory == "lgpio":
            from gpiozero.pins.lgpio import LGPIOFactory

            return LGPIOFactory()
        from gpiozero.pins.pigpio import PiGPIOFactory

        self._revision = _probe(backend.host, backend.port)
        factory: Any = PiGPIOFactory(host=backend.host, port=backend.port)
        # It would wait for an answer without end.
        factory.connection.sl.s.settimeout(backend.timeout_s)
        return factory


def _probe(host: str, port: int) -> int:
    """Return the hardware revision that pigpiod tells.

    pigpio itself waits without end for one that is silent, and prints its failures.
    """
    with socket.create_connection((host, port), _CONNECT_S) as line:
        line.settimeout(_CONNECT_S)
        line.sendall(_REQUEST.pack(_HARDWARE, 0, 0, 0))
        command, _, _, result = _REPLY.unpack(line.recv(_REPLY.size))
        if command != _HARDWARE or result <= 0:
            raise OSError("what answers is no pigpiod")
        return result


def _disconnect(factory: Any) -> None:
    with suppress(Exception):  # it may be gone already, in as many ways
        factory.connection.stop()


def _words(error: Exception) -> str:
    return (str(error).splitlines() or [""])[0] or type(error).__name__

"""Coils and discrete inputs of a PLC over Modbus TCP, through pymodbus."""

from __future__ import annotations

import logging
from typing import Any

from pymodbus import ModbusException
from pymodbus.client import ModbusTcpClient

from engine.document.equipment import DigitalInputPin, EquipmentDocument, ModbusPins
from robots.drivers.equipment.backends.pin_values import PinCommand, PinReading, PinValue
from robots.io.wire.link_error import LinkError

# What pymodbus logs is raised as well, and becomes our own message.
logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)


class ModbusPinsTransport:
    """Implements `DeviceTransport` over Modbus TCP."""

    def __init__(self, document: EquipmentDocument, backend: ModbusPins) -> None:
        self._backend = backend
        self._pins = document.pins
        self._safe = document.safe_values
        self._client: ModbusTcpClient | None = None

    @property
    def address(self) -> str:
        """Host and port of the PLC."""
        return f"{self._backend.host}:{self._backend.port}"

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        return f"check supply and network of the PLC, and that it answers Modbus unit {self._backend.unit}"

    def open(self) -> None:
        """Connect; outputs get their safe values."""
        backend = self._backend
        self._client = client = ModbusTcpClient(backend.host, port=backend.port, timeout=backend.timeout_s, retries=0)
        try:
            connected = client.connect()
        except (OSError, ModbusException) as error:
            raise LinkError(f"cannot connect: {error}") from error
        if not connected:
            raise LinkError("cannot connect")
        self.write(PinCommand(values=self._safe))

    def close(self) -> None:
        """Disconnect."""
        if self._client is not None:
            self._client.close()
            self._client = None

    def read(self) -> PinReading:
        """Read coils and discrete inputs, neighbours together."""
        client, values = self._opened(), dict[str, PinValue]()
        for reads, inputs in ((client.read_coils, False), (client.read_discrete_inputs, True)):
            pins = {name: pin for name, pin in self._pins.items() if isinstance(pin, DigitalInputPin) == inputs}
            for first, count in _runs(sorted(pin.pin for pin in pins.values())):
                bits = self._answer(reads, first, count=count).bits
                if len(bits) < count:
                    raise LinkError(f"the answer has {len(bits)} bits and not {count}")
                for name, pin in pins.items():
                    if first <= pin.pin < first + count:
                        values[name] = bool(bits[pin.pin - first]) != pin.active_low
        return PinReading(values=values)

    def write(self, command: PinCommand) -> None:
        """Write coils, one after the other."""
        client = self._opened()
        for name, value in command.values.items():
            pin = self._pins[name]
            self._answer(client.write_coil, pin.pin, bool(value) != pin.active_low)

    def _opened(self) -> ModbusTcpClient:
        if self._client is None:
            raise LinkError("not connected")
        return self._client

    def _answer(self, request: Any, *values: object, **options: object) -> Any:
        try:
            response = request(*values, **options, device_id=self._backend.unit)
        except (OSError, ModbusException, IndexError, ValueError) as error:
            # pymodbus lets IndexError and ValueError of its decoders out where a frame is garbage.
            words = (str(error).splitlines() or [type(error).__name__])[0]
            raise LinkError(f"no valid answer within {self._backend.timeout_s:g} s: {words}") from error
        if response.isError():
            raise LinkError(f"the PLC refused the request with Modbus exception {response.exception_code}")
        return response


_MOST_BITS = 2000
_LARGEST_GAP = 16


def _runs(numbers: list[int]) -> list[tuple[int, int]]:
    """Return which ranges to read, as first number and count."""
    runs: list[tuple[int, int]] = []
    for number in numbers:
        first, count = runs[-1] if runs else (number, 0)
        if runs and number - first < _MOST_BITS and number - (first + count) < _LARGEST_GAP:
            runs[-1] = first, number - first + 1
        else:
            runs.append((number, 1))
    return runs

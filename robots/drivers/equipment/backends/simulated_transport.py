"""Pins that are numbers in memory: the back end `simulated`."""

from __future__ import annotations

from engine.document.equipment import DigitalInputPin, EquipmentDocument
from robots.drivers.equipment.backends.pin_values import PinCommand, PinReading, PinValue


class SimulatedTransport:
    """Implements `DeviceTransport` in memory; its inputs are off."""

    def __init__(self, document: EquipmentDocument) -> None:
        self._safe = document.safe_values
        self._values: dict[str, PinValue] = {
            name: False if isinstance(pin, DigitalInputPin) else pin.safe for name, pin in document.pins.items()
        }

    @property
    def address(self) -> str:
        """Where the pins are."""
        return "simulated pins"

    @property
    def remedy(self) -> str:
        """What to check; memory does not fail."""
        return "nothing to check"

    def open(self) -> None:
        """Set outputs to their safe values, as every opening does."""
        self._values.update(self._safe)

    def close(self) -> None:
        """Nothing to disconnect."""

    def read(self) -> PinReading:
        """Return the values."""
        return PinReading(values=dict(self._values))

    def write(self, command: PinCommand) -> None:
        """Keep the values."""
        self._values.update(command.values)

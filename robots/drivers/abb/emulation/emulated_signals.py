"""The digital signals of the emulated controller: their values, and whether their device is there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

PATH = "/rw/iosystem/signals"
_NETWORK, _DEVICE = "DeviceNet", "BOARD10"


@dataclass
class EmulatedSignal:
    """One digital input."""

    network: str
    device: str
    name: str
    on: bool = False
    valid: bool = True
    simulated: bool = False

    @property
    def title(self) -> str:
        """Network, device and name."""
        return f"{self.network}/{self.device}/{self.name}"

    def resource(self) -> dict[str, object]:
        """Return it as Robot Web Services do."""
        value = str(int(self.on))
        return {
            "_type": "ios-signal",
            "_title": self.title,
            "name": self.name,
            "type": "DI",
            "category": "",
            "lvalue": value,
            "lstate": "simulated" if self.simulated else "not simulated",
            "unitnm": self.device,
            "phstate": "valid" if self.valid else "invalid",
            "pvalue": value,
            "ltime-sec": "0",
            "ltime-microsec": "0",
            "ptime-sec": "0",
            "ptime-microsec": "0",
            "quality": str(int(self.valid)),
        }


class EmulatedSignals:
    """All digital inputs, in the order of the inputs of the driver.

    Args:
        names: Each a name, or network, device and name with slashes.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._all = tuple(_signal(name) for name in names)

    def of(self, name: str) -> EmulatedSignal | None:
        """Return a signal by its name, alone or with network and device; None where there is none."""
        return next((signal for signal in self._all if name in (signal.name, signal.title)), None)

    def resources(self) -> list[dict[str, object]]:
        """Return all."""
        return [signal.resource() for signal in self._all]

    def set(self, number: int, *, on: bool) -> None:
        """Set one by the number that the driver gives it; nothing where it has none."""
        if number < len(self._all):
            self._all[number].on = on


def _signal(name: str) -> EmulatedSignal:
    *place, last = name.split("/")
    network, device = place if len(place) == 2 else (_NETWORK, _DEVICE)
    return EmulatedSignal(network=network, device=device, name=last)

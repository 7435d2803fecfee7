"""Equipment documents: the outputs and inputs of a module's computer or PLC, each under the name of its service."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.document.placement import Name
from engine.document.text.decoding import StrictModel

PinName = Annotated[
    str, Meta(pattern="^[A-Za-z][A-Za-z0-9_]{0,63}$", description="Letters, digits and `_`: the name of the service")
]
PinNumber = Annotated[
    int, Meta(ge=0, le=65535, description="BCM number of the GPIO, or address of the coil or discrete input from 0")
]
Duty = Annotated[float, Meta(ge=0.0, le=1.0, description="Part of a period in which the pin is on")]
AtStop = Annotated[
    Literal["keep", "safe"],
    Meta(description="What STOP does: `keep` leaves the value, as a clamp must hold on; `safe` sets the safe one"),
]
ActiveLow = Annotated[bool, Meta(description="Whether the pin is on at the low level")]
PULLS = Literal["none", "up", "down"]
MOST_GPIO = 53


class SimulatedPins(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="simulated"):
    """Pins that are numbers in the memory of the server."""


class GpiozeroPins(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="gpiozero"):
    """Pins of a Raspberry Pi: `lgpio` on this computer, `pigpio` by a pigpiod over the network, `mock` for trials."""

    factory: Annotated[Literal["mock", "pigpio", "lgpio"], Meta(description="What reaches the pins")]
    host: Annotated[str, Meta(min_length=1, description="Where pigpiod runs")] = "127.0.0.1"
    port: Annotated[int, Meta(ge=1, le=65535, description="Port of pigpiod")] = 8888
    timeout_s: Annotated[float, Meta(ge=0.02, le=0.1, description="Time limit of each request to pigpiod")] = 0.05


class ModbusPins(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="modbus_tcp"):
    """Coils as outputs and discrete inputs as inputs of a PLC."""

    host: Annotated[str, Meta(min_length=1)]
    port: Annotated[int, Meta(ge=1, le=65535)] = 502
    unit: Annotated[int, Meta(ge=0, le=255, description="Modbus address")] = 1
    timeout_s: Annotated[float, Meta(ge=0.02, le=0.1, description="Time limit of each request")] = 0.05


PinBackend = SimulatedPins | GpiozeroPins | ModbusPins


class DigitalOutputPin(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="digital_output"):
    """A pin that is on or off."""

    pin: PinNumber
    safe: Annotated[bool, Meta(description="Value at the start, at the end, and when the client is silent or gone")]
    active_low: ActiveLow = False
    at_stop: AtStop = "keep"


class DigitalInputPin(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="digital_input"):
    """A pin that is read."""

    pin: PinNumber
    active_low: ActiveLow = False
    pull: Annotated[PULLS, Meta(description="Resistor of the GPIO; a PLC has its own")] = "none"


class PwmPin(StrictModel, frozen=True, kw_only=True, tag_field="kind", tag="pwm"):
    """A pin that is switched on and off `frequency_hz` times a second."""

    pin: PinNumber
    safe: Duty
    frequency_hz: Annotated[float, Meta(ge=1.0, le=20000.0)] = 50.0
    active_low: ActiveLow = False
    at_stop: AtStop = "keep"


Pin = DigitalOutputPin | DigitalInputPin | PwmPin


class EquipmentDocument(StrictModel, frozen=True, kw_only=True):
    """What one equipment server serves. The name of a pin is that of its service."""

    flexcell: Literal[1]
    equipment: Name
    backend: PinBackend
    silence_s: Annotated[
        float, Meta(ge=0.05, le=0.2, description="Longest silence of the client until outputs are at their safe values")
    ] = 0.2
    pins: Annotated[dict[PinName, Pin], Meta(min_length=1)]

    @property
    def safe_values(self) -> dict[str, bool | float]:
        """The safe value of each output, by the name of its pin."""
        return {name: pin.safe for name, pin in self.pins.items() if not isinstance(pin, DigitalInputPin)}

    @property
    def inputs(self) -> dict[str, int]:
        """The digital inputs by name, each with its number among them."""
        names = (name for name, pin in self.pins.items() if isinstance(pin, DigitalInputPin))
        return {name: number for number, name in enumerate(names)}

    @property
    def outputs(self) -> dict[str, int]:
        """The digital outputs by name, each with its number among them; those with a duty are none."""
        names = (name for name, pin in self.pins.items() if isinstance(pin, DigitalOutputPin))
        return {name: number for number, name in enumerate(names)}

    @property
    def pwm_outputs(self) -> tuple[str, ...]:
        """The names of the outputs with a duty."""
        return tuple(name for name, pin in self.pins.items() if isinstance(pin, PwmPin))

    @property
    def stop_values(self) -> dict[str, bool | float]:
        """What STOP sets, by the name of the pin; those that keep their value are not in it."""
        return {
            name: pin.safe
            for name, pin in self.pins.items()
            if not isinstance(pin, DigitalInputPin) and pin.at_stop == "safe"
        }

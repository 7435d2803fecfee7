"""Makes the back end of an equipment document; loads its library only then."""

from __future__ import annotations

from importlib import import_module

from engine.document.equipment import EquipmentDocument, GpiozeroPins, ModbusPins, SimulatedPins
from engine.errors import RobotError
from robots.drivers.device_transport import DeviceTransport
from robots.drivers.equipment.backends.pin_values import PinCommand, PinReading
from robots.drivers.equipment.backends.simulated_transport import SimulatedTransport

PinTransport = DeviceTransport[PinReading, PinCommand]


def new_pin_transport(document: EquipmentDocument) -> PinTransport:
    """Return what reaches the pins, not yet connected; raises RobotError where a package is missing."""
    try:
        match document.backend:
            case SimulatedPins():
                return SimulatedTransport(document)
            case GpiozeroPins() as backend:
                import_module("gpiozero")
                if backend.factory != "mock":
                    import_module(backend.factory)
                from robots.drivers.equipment.backends.gpiozero_transport import GpiozeroTransport

                return GpiozeroTransport(document, backend)
            case ModbusPins() as backend:
                from robots.drivers.equipment.backends.modbus_pins_transport import ModbusPinsTransport

                return ModbusPinsTransport(document, backend)
    except ImportError as error:
        extra = "gpio" if isinstance(document.backend, GpiozeroPins) else "modbus"
        hint = f"pip install 'flexcell[{extra}]'"
        raise RobotError(f"the back end of {document.equipment} needs a package: {error}", hint=hint) from error

"""Equipment documents: pins under the names of their services; and the files of ReconCycle that say the same."""

from engine.document.equipment.equipment_document import (
    DigitalInputPin,
    DigitalOutputPin,
    EquipmentDocument,
    GpiozeroPins,
    ModbusPins,
    Pin,
    PinBackend,
    PwmPin,
    SimulatedPins,
)
from engine.document.equipment.equipment_file import Equipment, load_equipment, read_equipment
from engine.document.equipment.equipment_spec import EquipmentSpec, load_pins

__all__ = [
    "DigitalInputPin",
    "DigitalOutputPin",
    "Equipment",
    "EquipmentDocument",
    "EquipmentSpec",
    "GpiozeroPins",
    "ModbusPins",
    "Pin",
    "PinBackend",
    "PwmPin",
    "SimulatedPins",
    "load_equipment",
    "load_pins",
    "read_equipment",
]

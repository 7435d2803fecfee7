"""The contract of drivers and emulators, and what is installed: options, capabilities, reports. Connects to nothing.

Drivers are registered as `flexcell.drivers`, emulators as `flexcell.emulators`; both name their code by place, so that
a check or a schema loads none of it. A new device touches no file of the engine.
"""

from engine.cell.drivers.cell_schema import cell_schema_text
from engine.cell.drivers.device_context import DeviceContext
from engine.cell.drivers.device_report import DeviceReport, RoundTrip
from engine.cell.drivers.driver import DrivenDevice, Driver, DriverOptions
from engine.cell.drivers.driver_assignments import (
    AssignedDriver,
    DeviceKind,
    assigned_drivers,
    digital_inputs,
    digital_outputs,
    driven_kind,
    written_drivers,
)
from engine.cell.drivers.driver_registry import installed_driver, installed_drivers
from engine.cell.drivers.emulator_registry import Emulator, EmulatorOptions, Ready, emulator, installed_emulators

__all__ = [
    "AssignedDriver",
    "DeviceContext",
    "DeviceKind",
    "DeviceReport",
    "DrivenDevice",
    "Driver",
    "DriverOptions",
    "Emulator",
    "EmulatorOptions",
    "Ready",
    "RoundTrip",
    "assigned_drivers",
    "cell_schema_text",
    "digital_inputs",
    "digital_outputs",
    "driven_kind",
    "emulator",
    "installed_driver",
    "installed_drivers",
    "installed_emulators",
    "written_drivers",
]

"""Makes the device of equipment from its options."""

from __future__ import annotations

from engine.cell.drivers import DeviceContext, DeviceReport
from engine.clock import Clock
from engine.errors import CellError
from robots.drivers.equipment.device.equipment_device import EquipmentDevice
from robots.drivers.equipment.device.equipment_driver import EQUIPMENT, EquipmentOptions
from robots.drivers.equipment.device.equipment_transport import EquipmentTransport


def new_equipment(options: EquipmentOptions, *, name: str, clock: Clock, context: DeviceContext) -> EquipmentDevice:
    """Return the equipment, not yet connected.

    Raises:
        CellError: time is virtual.
    """
    if clock.virtual:
        hint = "run it in real time: without `--clock virtual`; or simulate it with `driver: sim`"
        raise CellError("real equipment has no virtual time", where=name, hint=hint)
    transport = EquipmentTransport(
        host=options.host,
        port=options.port,
        client=f"{name} of the cell {context.cell.name}",
        timeout_s=options.timeout_s,
    )
    about = DeviceReport(
        device=name,
        driver=EQUIPMENT.kind,
        address=transport.address,
        capabilities=tuple(sorted(EQUIPMENT.capabilities)),
        proven=EQUIPMENT.proven,
    )
    pins = context.cell.pins.get(name)
    return EquipmentDevice(name, transport, pins=pins.document if pins is not None else None, about=about)

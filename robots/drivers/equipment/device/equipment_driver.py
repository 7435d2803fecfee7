"""The driver `equipment`, as the entry point `flexcell.drivers` offers it, with its options. Loads no device."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cell.drivers import Driver, DriverOptions


class EquipmentOptions(DriverOptions, frozen=True, kw_only=True, tag="equipment"):
    """A computer that runs `flexcell equipment serve`."""

    host: Annotated[str, Meta(min_length=1, description="Where the server runs")]
    port: Annotated[int, Meta(ge=1, le=65535)] = 7391
    timeout_s: Annotated[float, Meta(ge=0.05, le=2.0, description="Time limit of each request")] = 0.5


EQUIPMENT = Driver(
    kind="equipment",
    drives="equipment",
    options=EquipmentOptions,
    capabilities=frozenset({"outputs"}),
    enabling="Takes control of the outputs, and sets none. Another client that controls them refuses it.",
    ports={"equipment": 7391},
    proven="Never run on hardware. Tested with the server of flexcell and pins in memory.",
    page="docs/how-to/serve-equipment.md",
    device="robots.drivers.equipment.device.new_equipment:new_equipment",
    not_captured="its frames to the equipment server; tcpdump records them",
)

"""What is known of the devices with a driver without asking them: the driver, what it can do, and its options."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec

from engine.cell.drivers.driver import Driver
from engine.cell.drivers.driver_assignments import AssignedDriver, written_drivers
from engine.document.cell import Cell
from engine.document.schema import one_line_texts
from engine.errors import FlexcellError
from engine.skill import CAPABILITIES


class DeviceDetails(msgspec.Struct, frozen=True, kw_only=True):
    """One device for which the document of the cell names a driver.

    Attributes:
        device: Its name in the document: `left`, `left/gripper`, `vice`.
        address: Its namespace on the bus, which names the kind of tool: `left/hand`.
        driver: The name of the driver.
        simulated: Whether the open cell simulates it instead.
        can: What the driver can do, in words.
        cannot: What it cannot do, in words, with the reason where there is one beside the device.
        proven: What it was tested against, and whether it ever ran on hardware.
        page: Path of its documentation.
        enabling: What enabling the device does at it.
        options: The options of the driver that are not at their defaults.
        schema: The JSON Schema of the options.
        problem: Why the driver or its options cannot be read; all else is empty then.
    """

    device: str
    address: str
    driver: str
    simulated: bool
    can: tuple[str, ...] = ()
    cannot: tuple[str, ...] = ()
    proven: str = ""
    page: str = ""
    enabling: str = ""
    options: dict[str, Any] = {}
    schema: dict[str, Any] = {}
    problem: str = ""


def devices_of_cell(cell: Cell | None) -> tuple[DeviceDetails, ...]:
    """Return the devices of an open cell that have a driver, in the order of its document."""
    return tuple(_details(each) for each in written_drivers(cell)) if cell is not None else ()


def _details(assigned: AssignedDriver) -> DeviceDetails:
    device = assigned.written_name
    known = DeviceDetails(
        device=device, address=device, driver=assigned.kind, simulated=device in assigned.cell.simulated
    )
    try:
        given = assigned.options(assigned.driver())
        driver = assigned.driver().configured(given)
        options: dict[str, Any] = msgspec.to_builtins(given)
    except FlexcellError as error:
        # A simulated device needs no driver that can be loaded.
        return msgspec.structs.replace(known, problem=error.message)
    return msgspec.structs.replace(
        known,
        address=assigned.device_name(driver),
        can=tuple(words for name, words in CAPABILITIES.items() if name in driver.capabilities),
        cannot=tuple(_missing(driver)),
        proven=driver.proven,
        page=driver.page,
        enabling=driver.enabling,
        options=options,
        schema=one_line_texts(msgspec.json.schema(driver.options)),
    )


def _missing(driver: Driver) -> Iterator[str]:
    """Yield what a driver of its kind of device could do and this one cannot."""
    if driver.drives == "arm":
        of_tools = {"gripper", "hand"}
        yield from (
            words for name, words in CAPABILITIES.items() if name not in driver.capabilities and name not in of_tools
        )
    yield from (f"{skill}: {reason}" for skill, reason in driver.missing_skills.items())

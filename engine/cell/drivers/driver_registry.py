"""The drivers of installed packages, and the options of one as a cell document writes them."""

from __future__ import annotations

from typing import Any

from engine.cell.drivers.driver import Driver, DriverOptions
from engine.document import DataPath, DocumentSource, decode_document
from engine.errors import RegistryError
from engine.registry import DRIVERS, load_factory, registered_names


def installed_driver(kind: str) -> Driver:
    """Return a driver by name.

    Raises:
        RegistryError: there is none, it needs a missing package, or its entry point offers no `Driver`.
    """
    offered = load_factory(DRIVERS, kind)
    if not isinstance(offered, Driver):
        raise RegistryError(
            f"the entry point of the driver {kind} offers no engine.cell.drivers.Driver",
            where=kind,
            hint="update the package that provides it",
        )
    return offered


def installed_drivers() -> dict[str, Driver]:
    """Return the drivers that can be loaded, by name."""
    found: dict[str, Driver] = {}
    for kind in registered_names(DRIVERS):
        try:
            found[kind] = installed_driver(kind)
        except RegistryError:
            continue  # the check of a cell that names it reports why
    return found


def driver_options(driver: Driver, source: DocumentSource, path: DataPath) -> DriverOptions:
    """Return the options that a document has at `path`.

    Raises:
        DocumentError: an option is unknown, missing or invalid; `where` is its position, `others` are the others.
    """
    data: Any = source.data
    place = source.place
    for step in path:
        data = data[step]  # the cell was decoded from it
        place = (place.children or {}).get(step, place)
    part = DocumentSource(file=place.file or source.file, data=data, place=place)
    return decode_document(part, driver.options)

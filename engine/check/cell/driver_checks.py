"""Checks the drivers of a cell document: they exist, fit their devices, and accept their options."""

from __future__ import annotations

from collections.abc import Iterator

from engine.cell.drivers import AssignedDriver, assigned_drivers
from engine.check.finding import Finding, new_finding
from engine.document.cell import Cell
from engine.errors import CellError, DocumentError, Position, RegistryError
from engine.registry import DRIVERS, registered_names
from engine.wording.suggestions import did_you_mean


def check_drivers(cell: Cell) -> Iterator[Finding]:
    """Find drivers that do not exist or do not fit, and options that they refuse; connects to nothing."""
    for assigned in assigned_drivers(cell) if cell.document.real_devices else ():
        yield from _check(assigned)


def _check(assigned: AssignedDriver) -> Iterator[Finding]:
    source, known = assigned.cell.source, registered_names(DRIVERS)
    position = source.position((*assigned.path, "kind"))
    if assigned.kind not in known:
        message = f"there is no driver `{assigned.kind}`"
        hint = did_you_mean(assigned.kind, known) if known else "none is installed; use `driver: sim`"
        yield new_finding("unknown-driver", message, path="", position=position, hint=hint or "use `driver: sim`")
        return
    try:
        driver = assigned.driver()
    except CellError as error:
        yield new_finding("unfit-driver", error.message, path="", position=position, hint=error.hint or "")
        return
    except RegistryError as error:
        yield new_finding("unknown-driver", error.message, path="", position=position, hint=error.hint or "")
        return
    try:
        assigned.options(driver)
    except DocumentError as error:
        for mistake in (error, *error.others):
            place = mistake.where if isinstance(mistake.where, Position) else position
            message = f"driver {driver.kind}: {mistake.message}"
            yield new_finding("bad-driver-option", message, path="", position=place, hint=mistake.hint or "")

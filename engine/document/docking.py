"""Which modules of a cell are docked where: the cell as it stands then, for everybody who simulates or measures it."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec.structs import replace

from engine.document.cell import Cell, CellDocument
from engine.document.cell_frames import WORLD, FrameSpec
from engine.document.cell_modules import module_below

Docks = Mapping[str, str]
"""The connector of each module that is plugged."""


def docks_at_start(cell: Cell) -> dict[str, str]:
    """Return where modules are docked when the cell is opened."""
    modules = cell.document.modules.items()
    return {name: spec.connector for name, spec in modules if spec.plugged and spec.connector is not None}


def cell_at_start(cell: Cell) -> CellDocument:
    """Return the document of a cell with the modules that are docked when it is opened."""
    return cell_as_docked(cell, docks_at_start(cell))


def cell_as_docked(cell: Cell, docks: Docks) -> CellDocument:
    """Return the document of a cell with only those modules that are plugged, at their connectors.

    Frames that stand on a module which is not plugged are left out, connectors among them. The connectors exist and
    no module stands on itself.
    """
    document = cell.document
    if docks == {name: spec.connector for name, spec in document.modules.items()}:
        return document
    modules = {name: replace(document.modules[name], connector=connector) for name, connector in docks.items()}
    own = replace(
        document,
        modules=modules,
        frames={name: one for name, one in document.frames.items() if not _of_module(cell, name)},
        fixtures={name: one for name, one in document.fixtures.items() if not _of_module(cell, name)},
        parts={name: one for name, one in document.parts.items() if not _of_module(cell, name)},
        cameras={name: one for name, one in document.cameras.items() if not _of_module(cell, name)},
        bonds={name: one for name, one in document.bonds.items() if not _of_module(cell, name)},
        devices={name: one for name, one in document.devices.items() if not _of_module(cell, name)},
    )
    joined = own.with_modules({name: cell.modules[name] for name in docks})
    present = {WORLD, *joined.fixtures, *joined.frames}
    while gone := {name for name, one in joined.frames.items() if name in present and one.parent not in present}:
        present -= gone
    frames: dict[str, FrameSpec] = {name: one for name, one in joined.frames.items() if name in present}
    return replace(joined, frames=frames).in_world()


def modules_below(cell: Cell) -> dict[str, str]:
    """Return, by connector, the module that carries it, for connectors that stand on modules."""
    document = cell.document
    below = {
        name: module_below(name, modules=document.modules, frames=document.frames, fixtures=document.fixtures)
        for name in document.connectors
    }
    return {connector: module for connector, module in below.items() if module}


def _of_module(cell: Cell, name: str) -> bool:
    return name.partition("/")[0] in cell.document.modules

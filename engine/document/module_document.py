"""Module documents: what stands on a module of a cell, relative to the frame of the module itself.

A module is a folder with a `module.yaml`. Lengths are in metres, angles in radians, masses in kilograms.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Literal

from msgspec import Meta

from engine.document.cell_bodies import Fixture, PartSpec, require_sizes
from engine.document.cell_bonds import BondSpec, require_bonds
from engine.document.cell_devices import DeviceSpec, require_devices
from engine.document.cell_frames import WORLD, FrameSpec, require_frames
from engine.document.cell_perception import DepthCamera
from engine.document.device_pins import refuse_equipment
from engine.document.hexapods.hexapod_rules import require_hexapods
from engine.document.linear_units.linear_unit_rules import refuse_linear_units
from engine.document.placement import Name
from engine.document.text.decoding import StrictModel, decode_document
from engine.document.text.document_file import DocumentFile
from engine.document.text.yaml_source import DataPath, DocumentSource, load_source
from engine.errors import DocumentError

MODULE_FILE = "module.yaml"


class ModuleDocument(StrictModel, frozen=True, kw_only=True):
    """A module as written: everything stands in the frame of the module, unless it names another frame of it."""

    flexcell: Literal[1]
    module: Name
    description: str = ""
    frames: Annotated[
        dict[Name, FrameSpec], Meta(description="Frames of the module: slots, grips, places to dock others")
    ] = {}
    fixtures: dict[Name, Fixture] = {}
    parts: dict[Name, PartSpec] = {}
    cameras: dict[Name, DepthCamera] = {}
    devices: Annotated[
        dict[Name, DeviceSpec], Meta(description="What moves or switches: vices, clamps, slides, lamps")
    ] = {}
    bonds: Annotated[dict[Name, BondSpec], Meta(description="What joins parts to one another or to fixtures")] = {}

    def uses_of_frames(self) -> Iterator[tuple[DataPath, str]]:
        """Yield in which frames things stand that are no frames, each with its path in the document."""
        yield from ((("parts", name, "at", "frame"), part.at.frame) for name, part in self.parts.items())
        yield from ((("cameras", name, "frame"), camera.frame) for name, camera in self.cameras.items())


class Module(DocumentFile[ModuleDocument]):
    """A module document with its file."""


def load_module(folder: Path) -> Module:
    """Read the document of a module.

    Args:
        folder: Its folder, or the document itself.

    Raises:
        DocumentError: the file cannot be read or is not a valid module; `where` is the position.
    """
    file = folder if folder.suffix else folder / MODULE_FILE
    return module_of_source(load_source(file), file=file)


def module_of_source(source: DocumentSource, *, file: Path) -> Module:
    """Return the module that parsed data describe.

    Raises:
        DocumentError: as `load_module`.
    """
    document = decode_document(source, ModuleDocument)
    require_sizes(document.fixtures, document.parts, source)
    require_devices(document.devices, source, fixtures=document.fixtures)
    refuse_equipment(document.devices, source)
    require_bonds(document.bonds, source, parts=document.parts, fixtures=document.fixtures)
    require_frames(
        document.frames,
        source,
        fixtures=document.fixtures,
        uses=document.uses_of_frames(),
        taken={**dict.fromkeys(document.parts, "part"), **dict.fromkeys(document.cameras, "camera")},
        whole="module",
    )
    refuse_linear_units(document.devices, source)
    uses = document.uses_of_frames()
    require_hexapods(document.devices, source, fixtures=document.fixtures, frames=document.frames, uses=uses)
    for path, frame in _parents(document):
        if frame == WORLD and _is_written(source, path):
            raise DocumentError(
                f"`{path[1]}` stands in `{WORLD}`, which a module does not know",
                where=source.position(path),
                hint=f"remove `{path[-1]}`: it stands in the frame of the module then, which the cell places",
            )
    return Module(document=document, file=file, source=source)


def _parents(document: ModuleDocument) -> Iterator[tuple[DataPath, str]]:
    """Yield in which frame everything stands, each with its path in the document."""
    yield from ((("frames", name, "parent"), frame.parent) for name, frame in document.frames.items())
    yield from ((("fixtures", name, "at", "frame"), fixture.at.frame) for name, fixture in document.fixtures.items())
    yield from document.uses_of_frames()


def _is_written(source: DocumentSource, path: DataPath) -> bool:
    """Return whether a value is in the document, and not a default."""
    place = source.place
    for step in path:
        if place.children is None or step not in place.children:
            return False
        place = place.children[step]
    return True

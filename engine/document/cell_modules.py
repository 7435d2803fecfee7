"""Modules in a cell document: where they are docked, and what stands in the cell with them.

What stands on the module `vice` has names below it: the fixture `jaws` is `vice/jaws` in the cell. `vice` itself is the
frame of the module, which stands at its connector.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated

from msgspec import Meta
from msgspec.structs import replace

from engine.document.cell_bodies import Fixture, PartSpec
from engine.document.cell_bonds import BondSpec
from engine.document.cell_devices import DeviceSpec, placed_device
from engine.document.cell_frames import WORLD, FrameSpec
from engine.document.cell_perception import DepthCamera
from engine.document.module_document import Module, ModuleDocument, load_module
from engine.document.placement import Name
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DataPath, DocumentSource, PositionTree
from engine.errors import DocumentError
from engine.wording import did_you_mean

_SECTIONS = ("frames", "fixtures", "parts", "cameras", "devices", "bonds")


class ModuleSpec(StrictModel, frozen=True, kw_only=True):
    """A module of the cell: what stands on it has names in the cell, also while it is not plugged."""

    module: Annotated[str, Meta(min_length=1, description="Folder of its `module.yaml`, relative to this document")]
    connector: Annotated[
        Name | None, Meta(description="The connector that it is docked to, or is plugged to if none is named then")
    ] = None
    plugged: Annotated[bool, Meta(description="Whether it is docked when the cell is opened")] = True
    equipment: Annotated[Name | None, Meta(description="Equipment of the cell on whose pins its devices are")] = None


class DockedModule(StrictModel, frozen=True, kw_only=True):
    """What stands in the cell with a module, by its names there; everything stands in frames of the cell."""

    frames: dict[str, FrameSpec]
    fixtures: dict[str, Fixture]
    parts: dict[str, PartSpec]
    cameras: dict[str, DepthCamera]
    devices: dict[str, DeviceSpec]
    bonds: dict[str, BondSpec]


def load_modules(
    modules: Mapping[str, ModuleSpec], *, connectors: Mapping[str, FrameSpec], source: DocumentSource, folder: Path
) -> dict[str, Module]:
    """Return the modules of a cell document in `folder`, by their names in the cell.

    Raises:
        DocumentError: a connector is unknown or carries two modules, or a module cannot be read or is not valid.
    """
    docked: dict[str, str] = {}
    for name, spec in modules.items():
        if spec.connector is None:
            if spec.plugged:
                raise DocumentError(
                    f"module `{name}` is docked to no connector",
                    where=source.position(("modules", name), of_key=True),
                    hint="add `connector:`, or `plugged: false` for a module that is plugged later",
                )
            continue
        where = source.position(("modules", name, "connector"))
        if spec.connector not in connectors:
            hint = did_you_mean(spec.connector, connectors) if connectors else "add `connectors:`"
            raise DocumentError(f"the cell has no connector `{spec.connector}`", where=where, hint=hint)
        if not spec.plugged:
            continue
        if spec.connector in docked:
            raise DocumentError(
                f"`{docked[spec.connector]}` and `{name}` are docked to the same connector",
                where=where,
                hint="choose another connector for one of them",
            )
        docked[spec.connector] = name
    loaded: dict[str, Module] = {}
    for name, spec in modules.items():
        folder_of_module = folder / spec.module
        if not folder_of_module.exists():
            raise DocumentError(
                f"module `{name}` is not there: {folder_of_module}",
                where=source.position(("modules", name, "module")),
                hint="give the folder of its `module.yaml`, relative to this document",
            )
        loaded[name] = _below(load_module(folder_of_module), Path(spec.module))
    return loaded


def _below(module: Module, folder: Path) -> Module:
    """Return a module whose mesh files are relative to the document that names the module."""
    folder = folder.parent if folder.suffix else folder
    fixtures = {
        name: replace(one, file=(folder / one.file).as_posix()) if one.file is not None else one
        for name, one in module.document.fixtures.items()
    }
    return Module(document=replace(module.document, fixtures=fixtures), file=module.file, source=module.source)


def docked(name: str, document: ModuleDocument, *, connector: str, equipment: str | None = None) -> DockedModule:
    """Return what stands in the cell with a module of this name."""
    own = {*document.frames, *document.fixtures}

    def named(item: str) -> str:
        return f"{name}/{item}"

    def frame(written: str) -> str:
        return named(written) if written in own else name if written == WORLD else written

    def camera(one: DepthCamera) -> DepthCamera:
        detect = one.detect
        if detect is not None:
            labels = {named(part) if part in document.parts else part: label for part, label in detect.labels.items()}
            seen_in = named(detect.frame) if detect.frame in own else detect.frame
            detect = replace(detect, labels=labels, frame=seen_in)
        return replace(one, frame=frame(one.frame), detect=detect)

    return DockedModule(
        frames={
            name: FrameSpec(parent=connector),
            **{named(key): replace(one, parent=frame(one.parent)) for key, one in document.frames.items()},
        },
        fixtures={
            named(key): replace(one, at=replace(one.at, frame=frame(one.at.frame)))
            for key, one in document.fixtures.items()
        },
        parts={
            named(key): replace(one, at=replace(one.at, frame=frame(one.at.frame)))
            for key, one in document.parts.items()
        },
        cameras={named(key): camera(one) for key, one in document.cameras.items()},
        devices={named(key): placed_device(one, named, equipment=equipment) for key, one in document.devices.items()},
        bonds={named(key): replace(one, part=named(one.part), to=named(one.to)) for key, one in document.bonds.items()},
    )


def module_below(
    frame: str, *, modules: Iterable[str], frames: Mapping[str, FrameSpec], fixtures: Mapping[str, Fixture]
) -> str:
    """Return the module on which a frame of the cell stands, or whose frame it is; empty for none.

    The frames lead to the world, as `require_frames` requires.
    """
    while frame != WORLD:
        module = frame.partition("/")[0]
        if module in modules:
            return module
        frame = frames[frame].parent if frame in frames else fixtures[frame].at.frame
    return ""


def require_plugged(
    modules: Mapping[str, ModuleSpec],
    loaded: Mapping[str, Module],
    source: DocumentSource,
    *,
    resting: Iterable[tuple[DataPath, str]],
    below: Mapping[str, str],
) -> None:
    """Require that nothing of the cell stands on a module that is not plugged when the cell is opened.

    Args:
        modules: The modules.
        loaded: Their documents.
        source: The document of the cell.
        resting: What of the cell stands on modules, each by its path with the module.
        below: The module below each connector that is on a module.

    Raises:
        DocumentError: something does, or such a module carries cameras.
    """
    for name, spec in modules.items():
        if spec.plugged or not loaded[name].document.cameras:
            continue
        raise DocumentError(
            f"module `{name}` carries cameras, and such a module cannot be plugged while the cell is open",
            where=source.position(("modules", name, "plugged"), of_key=True),
            hint="remove `plugged: false`, or the cameras of the module",
        )
    waiting = {name for name, spec in modules.items() if not spec.plugged}
    docked_on: list[tuple[DataPath, str]] = [
        (("modules", name, "connector"), below[spec.connector])
        for name, spec in modules.items()
        if spec.plugged and spec.connector is not None and spec.connector in below
    ]
    for path, module in (*docked_on, *resting):
        if module in waiting:
            raise DocumentError(
                f"`{path[1]}` stands on module `{module}`, which is not plugged when the cell is opened",
                where=source.position(path),
                hint=f"plug `{module}` from the start, or place `{path[1]}` elsewhere",
            )


def with_positions(source: DocumentSource, modules: Mapping[str, Module]) -> DocumentSource:
    """Return the source of a cell that also knows where the items of its modules are written, in their files."""
    root = source.place
    sections = dict(root.children or {})

    def add(section: str, items: Mapping[str | int, PositionTree], *, beside: PositionTree) -> None:
        known = sections.get(section)
        kept = (known.children if known is not None else None) or {}
        sections[section] = _with_children(known or beside, {**kept, **items})

    connectors, docked_here = sections.get("connectors"), sections.get("modules")
    if connectors is not None:
        add("frames", connectors.children or {}, beside=connectors)
    for name, module in modules.items():
        assert docked_here is not None
        add("frames", {name: (docked_here.children or {})[name]}, beside=docked_here)
        written = module.source.place.children or {}
        for section in _SECTIONS:
            items = (written[section].children if section in written else None) or {}
            placed: dict[str | int, PositionTree] = {
                f"{name}/{key}": _in_file(place, module.source.file) for key, place in items.items()
            }
            if placed:
                add(section, placed, beside=docked_here)
    return DocumentSource(file=source.file, data=source.data, place=_with_children(root, sections))


def _with_children(place: PositionTree, children: dict[str | int, PositionTree]) -> PositionTree:
    return PositionTree(place.key_line, place.key_column, place.line, place.column, children, place.file)


def _in_file(place: PositionTree, file: str) -> PositionTree:
    inner = {key: _in_file(each, file) for key, each in place.children.items()} if place.children is not None else None
    return PositionTree(place.key_line, place.key_column, place.line, place.column, inner, file)

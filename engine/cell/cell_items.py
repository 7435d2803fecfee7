"""What a cell consists of, for a person who reads it: each item with its place in the document and on the bus.

Items are addressed as in the document: `robots/left`, `robots/left/gripper`, `parts/hca_north`, `world`; those of a
module by their names in the cell: `fixtures/vice/jaws`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import msgspec

from engine.cell.robot_models import tool_kinds
from engine.document.cell import Cell, CellDocument
from engine.document.cell_meshes import mesh_digests
from engine.document.text.yaml_source import DocumentSource, PositionTree, load_text, parse_source
from engine.errors import DocumentError
from engine.skills.modules import MODULES_TOPIC

ItemKind = Literal[
    "robot",
    "tool",
    "equipment",
    "device",
    "module",
    "bond",
    "fixture",
    "part",
    "frame",
    "camera",
    "person",
    "occupancy",
    "world",
    "store",
]


class CellItem(msgspec.Struct, frozen=True, kw_only=True):
    """One item of a cell.

    `model` says what it is, in the words of the document: `panda`, `box`, `mujoco`. `owner` is the address of the item
    that carries it, empty for one that stands by itself. `topics` are those of the bus that tell of it. `text` are
    its lines of the document, the first of which has the number `line`, from 1; `file` is the document of its module,
    empty for that of the cell.
    """

    path: str
    kind: ItemKind
    name: str
    model: str
    owner: str = ""
    topics: tuple[str, ...] = ()
    text: str = ""
    line: int = 0
    file: str = ""


class CellItems(msgspec.Struct, frozen=True, kw_only=True):
    """The items of a cell in the order of its document, which is `file`.

    `changed` says that the document has changed since the cell was opened: the items are those of the open cell, and
    their lines those of the document now.
    """

    cell: str
    description: str
    file: str
    changed: bool
    items: tuple[CellItem, ...]


def named_items(cell: Cell | None, *, topics: Iterable[str] = ()) -> Iterator[CellItem]:
    """Yield the items of an open cell without their lines, for which the document would have to be read again."""
    known = tuple(sorted(topics))
    for item in _items(cell) if cell is not None else ():
        yield msgspec.structs.replace(item, topics=_topics(item, known))


def items_of_cell(cell: Cell | None, *, name: str, topics: Iterable[str] = ()) -> CellItems:
    """Return the items of an open cell.

    Args:
        cell: The cell as it was opened; None for one that no document describes, which has no items to list.
        name: The name of the cell.
        topics: The names of all topics on its bus.
    """
    if cell is None:
        return CellItems(cell=name, description="", file="", changed=False, items=())
    text = _read(cell.file)
    modules = {name: _read(module.file) for name, module in cell.modules.items()}
    pins = tuple(_read(each.file) for each in cell.pins.values())
    meshes = mesh_digests(cell.meshes, cell.file.parent)
    items = tuple(_with_lines(item, cell, text, modules) for item in named_items(cell, topics=topics))
    return CellItems(
        cell=name,
        description=cell.document.description,
        file=cell.file.name,
        changed=(*(each.data for each in (text, *modules.values(), *pins)), meshes) != cell.content,
        items=items,
    )


@dataclass(frozen=True, kw_only=True)
class TextExcerpts:
    """A document as it is now, with its lines; without `source` while it cannot be read."""

    source: DocumentSource | None = None
    lines: list[str] = field(default_factory=list[str])

    @property
    def data(self) -> object:
        """Its plain data; None while it cannot be read."""
        return self.source.data if self.source is not None else None

    def of(self, path: Sequence[str]) -> tuple[str, int]:
        """Return the lines of an item and the number of the first one, from 1; no text and 0 where it is no more.

        They end before the next key of the item or of what contains it.
        """
        place, later = (self.source.place, []) if self.source is not None else (None, list[int]())
        for step in path:
            children = place.children if place is not None else None
            place = children.get(step) if children is not None else None
            if place is None or children is None:
                return "", 0
            later += [each.key_line for each in children.values()]
        if place is None or place.file is not None:
            return "", 0
        end = min((line for line in later if line > place.key_line), default=len(self.lines))
        return "\n".join(_own(self.lines[place.key_line : end], place)), place.key_line + 1


def _read(file: Path) -> TextExcerpts:
    try:
        content = load_text(file)
        return TextExcerpts(source=parse_source(content, file=str(file)), lines=content.decode().splitlines())
    except DocumentError:
        return TextExcerpts()


def _with_lines(item: CellItem, cell: Cell, text: TextExcerpts, modules: Mapping[str, TextExcerpts]) -> CellItem:
    """Return the item with its lines, of the document of its module where it stands on one."""
    section, _, name = item.path.partition("/")
    module, _, key = name.partition("/")
    if section == "robots" or module not in modules or not key:
        lines, line = text.of(item.path.split("/"))
        return msgspec.structs.replace(item, text=lines, line=line)
    lines, line = modules[module].of([section, key])
    file = os.path.relpath(cell.modules[module].file, cell.file.parent)
    return msgspec.structs.replace(item, text=lines, line=line, file=Path(file).as_posix())


def _items(cell: Cell) -> Iterator[CellItem]:
    document = cell.document
    yield from _robots(document)
    for name, equipment in document.equipment.items():
        model = cell.pins[name].document.equipment if name in cell.pins else equipment.driver_kind
        yield CellItem(path=f"equipment/{name}", kind="equipment", name=name, model=model)

    def owner(name: str) -> str:
        """Return the address of the module that something stands on; empty without one."""
        module = name.partition("/")[0]
        return f"modules/{module}" if module in document.modules else ""

    for name, module in cell.modules.items():
        yield CellItem(path=f"modules/{name}", kind="module", name=name, model=module.document.module)
    for name, fixture in document.fixtures.items():
        yield CellItem(path=f"fixtures/{name}", kind="fixture", name=name, model=fixture.shape, owner=owner(name))
    for name, device in document.devices.items():
        model = ", ".join(device.positions)
        yield CellItem(path=f"devices/{name}", kind="device", name=name, model=model, owner=owner(name))
    for name, part in document.parts.items():
        yield CellItem(path=f"parts/{name}", kind="part", name=name, model=part.shape, owner=owner(name))
    for name, bond in document.bonds.items():
        yield CellItem(path=f"bonds/{name}", kind="bond", name=name, model=bond.kind, owner=owner(name))
    for name, frame in document.frames.items():
        section = "connectors" if name in document.connectors else "frames"
        if name not in document.modules:
            yield CellItem(
                path=f"{section}/{name}", kind="frame", name=name, model=f"in {frame.parent}", owner=owner(name)
            )
    for name, camera in document.cameras.items():
        yield CellItem(path=f"cameras/{name}", kind="camera", name=name, model=camera.driver, owner=owner(name))
    for name in document.people:
        yield CellItem(path=f"people/{name}", kind="person", name=name, model="arm")
    if document.occupancy is not None:
        yield CellItem(path="occupancy", kind="occupancy", name="occupancy", model="voxels")
    if document.world is not None:
        yield CellItem(path="world", kind="world", name="world", model="mujoco")
    if document.store is not None:
        tag = type(document.store).__struct_config__.tag
        yield CellItem(path="store", kind="store", name="store", model=str(tag))


def _robots(document: CellDocument) -> Iterator[CellItem]:
    """Yield the robots, each followed by its tool or its tool changer."""
    for name, robot in document.robots.items():
        path = f"robots/{name}"
        yield CellItem(path=path, kind="robot", name=name, model=robot.model)
        if robot.gripper is not None:
            yield CellItem(path=f"{path}/gripper", kind="tool", name=name, model=robot.gripper.model, owner=path)
        if robot.tool_changer is not None:
            yield CellItem(path=f"{path}/tool_changer", kind="tool", name=name, model="tool changer", owner=path)


def _topics(item: CellItem, known: tuple[str, ...]) -> tuple[str, ...]:
    """Return the topics below the name of an item; those of a tool are below its robot: `left/gripper/state`."""
    tools = (*(f"{item.name}/{kind}/" for kind in tool_kinds()), f"{item.name}/tool_changer")
    match item.kind:
        case "robot":
            return tuple(each for each in known if each.startswith(f"{item.name}/") and not each.startswith(tools))
        case "tool":
            return tuple(each for each in known if each.startswith(tools))
        case "camera" | "equipment" | "device":
            return tuple(each for each in known if each.startswith(f"{item.name}/"))
        case "part":
            return tuple(each for each in known if each == "cell/parts")
        case "bond":
            return tuple(each for each in known if each == "cell/bonds")
        case "occupancy":
            return tuple(each for each in known if each.startswith("cell/occupancy"))
        case "world":
            return tuple(each for each in known if each in ("cell/frames", "cell/planning_scene"))
        case "module":
            return tuple(each for each in known if each == MODULES_TOPIC)
        case "fixture" | "frame" | "person" | "store":
            return ()


def _own(lines: list[str], place: PositionTree) -> list[str]:
    """Return lines without the blank ones and the comments at their end, which belong to what follows."""
    end = len(lines)
    while end > 1 and (not lines[end - 1].strip() or _is_comment(lines[end - 1], place.key_column)):
        end -= 1
    margin = " " * (len(lines[0]) - len(lines[0].lstrip()))
    return [line.removeprefix(margin) for line in lines[:end]]


def _is_comment(line: str, column: int) -> bool:
    stripped = line.lstrip()
    return stripped.startswith("#") and len(line) - len(stripped) <= column

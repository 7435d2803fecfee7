"""Where a cell or module document names its own items: what stands in a frame, is docked to a connector, has a label.

Devices name the fixtures that they move, bonds what they join, interlocks other devices. Everything works on plain data
that may be wrong in any way; what is not as it should be names nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import cast

from engine.editing.cells.cell_edit import CellSection

NAMED_SECTIONS = (
    "robots",
    "fixtures",
    "parts",
    "cameras",
    "people",
    "unknown_bodies",
    "frames",
    "connectors",
    "modules",
)
"""The sections whose items share one space of names."""
_ON_BUS = ("robots", "cameras", "people", "equipment", "devices")
_FRAME_SECTIONS = frozenset(("fixtures", "frames", "connectors", "modules"))
# Where each section names a frame, from the item inward.
_FRAME_FIELDS: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "robots": (("base", "frame"),),
    "fixtures": (("at", "frame"),),
    "parts": (("at", "frame"),),
    "unknown_bodies": (("at", "frame"),),
    "cameras": (("frame",), ("detect", "frame")),
    "people": (("frame",),),
    "frames": (("parent",),),
    "connectors": (("parent",),),
}
Fields = dict[str, object]


@dataclass(frozen=True)
class NameInUse:
    """A place that names an item: `holder[key]`, or with `is_key` the key itself; `by` is the item that has it."""

    holder: Fields | list[object]
    key: str | int
    by: str
    is_key: bool = False

    @property
    def written(self) -> str:
        """The name as it is written here."""
        return str(self.key) if self.is_key else str(cast("Fields", self.holder)[cast("str", self.key)])

    def rename(self, name: str) -> None:
        """Write another name here; keys keep their order."""
        if not self.is_key:
            cast("Fields", self.holder)[cast("str", self.key)] = name
            return
        rename_key(cast("Fields", self.holder), str(self.key), name)


def sections_beside(section: CellSection) -> tuple[str, ...]:
    """Return the sections in which a name of this section must be free."""
    match section:
        case "bonds":
            return ("bonds",)
        case "equipment" | "devices":
            return _ON_BUS
        case "robots" | "cameras":
            return (*NAMED_SECTIONS, "equipment", "devices")
        case _:
            return NAMED_SECTIONS


def rename_key(fields: Fields, old: str, new: str) -> None:
    """Rename a key; all keys keep their order."""
    entries = [(new if key == old else key, value) for key, value in fields.items()]
    fields.clear()
    fields.update(entries)


def fields_in(fields: object, key: str) -> Fields:
    """Return the mapping under a key; an empty one that is in no document if there is none."""
    found = cast("Fields", fields).get(key) if isinstance(fields, dict) else None
    return cast("Fields", found) if isinstance(found, dict) else {}


def items_in(data: Fields, section: str) -> Iterator[tuple[str, Fields]]:
    """Yield the items of a section that are mappings, by name."""
    for name in fields_in(data, section):
        item = fields_in(data[section], name)
        if item:
            yield name, item


def uses_of(data: Fields, section: CellSection, name: str) -> Iterator[NameInUse]:
    """Yield where the document names an item of this section; for a module also what stands on it: `vice/jaws`."""
    below = f"{name}/" if section == "modules" else None
    places: list[tuple[Fields | list[object], str | int, str]] = []

    def is_meant(written: object) -> bool:
        return written == name or (below is not None and isinstance(written, str) and written.startswith(below))

    if section in _FRAME_SECTIONS:
        places += _frame_places(data)
    if section == "connectors":
        places += [(item, "connector", module) for module, item in items_in(data, "modules")]
    if section in ("parts", "fixtures", "modules"):
        places += [(item, key, bond) for bond, item in items_in(data, "bonds") for key in ("part", "to")]
    if section in ("fixtures", "frames", "modules"):
        places += _places_of_devices(data)
    if section in ("devices", "modules"):
        places += [
            (lock, "device", by) for by, item in items_in(data, "devices") for lock in _mappings(item.get("interlocks"))
        ]
    if section == "equipment":
        owners = (*items_in(data, "devices"), *items_in(data, "modules"))
        places += [(item, "equipment", by) for by, item in owners]
    for holder, key, by in places:
        use = NameInUse(holder, key, by)
        if (isinstance(holder, list) or key in holder) and is_meant(use.written):
            yield use
    if section in ("parts", "modules"):
        for camera, item in items_in(data, "cameras"):
            labels = fields_in(item.get("detect"), "labels")
            yield from (NameInUse(labels, part, camera, is_key=True) for part in list(labels) if is_meant(part))


def _frame_places(data: Fields) -> Iterator[tuple[Fields, str, str]]:
    for section, places in _FRAME_FIELDS.items():
        for name, item in items_in(data, section):
            for *outer, key in places:
                holder = item
                for step in outer:
                    holder = fields_in(holder, step)
                if key in holder:
                    yield holder, key, name


def uses_in_devices(data: Fields, device: str, group: str, name: str) -> Iterator[NameInUse]:
    """Yield where devices name an axis, sensor or position of a device."""
    item = fields_in(data.get("devices"), device)
    if group == "axes":
        sensors = (sensor for _, sensor in items_in(item, "sensors"))
        yield from (NameInUse(sensor, "axis", device) for sensor in sensors if sensor.get("axis") == name)
    if group == "sensors":
        for _, position in items_in(item, "positions"):
            steps = (step for step in _mappings(position.get("steps")))
            levels = (fields_in(position, "sensors"), *(fields_in(step, "wait_for") for step in steps))
            yield from (NameInUse(each, name, device, is_key=True) for each in levels if name in each)
    if group == "positions":
        hexapod = fields_in(item, "hexapod")
        places: list[tuple[Fields, str, str]] = [(hexapod, key, device) for key in ("released", "locked")]
        places += [(lock, "position", device) for lock in _mappings(item.get("interlocks"))]
        for by, other in items_in(data, "devices"):
            locks = _mappings(other.get("interlocks"))
            places += [(lock, "at", by) for lock in locks if lock.get("device") == device]
        yield from (NameInUse(holder, key, by) for holder, key, by in places if holder.get(key) == name)


def _places_of_devices(data: Fields) -> Iterator[tuple[Fields | list[object], str | int, str]]:
    """Yield where devices name fixtures, and the frame at which a hexapod is gripped."""
    for name, device in items_in(data, "devices"):
        for group in ("axes", "belts"):
            for _, moving in items_in(device, group):
                yield moving, "body", name
                yield from ((holder, at, name) for holder, at in _entries(moving.get("against")))
        for _, sensor in items_in(device, "sensors"):
            yield fields_in(sensor, "beam"), "body", name
        hexapod = fields_in(device, "hexapod")
        yield from ((hexapod, key, name) for key in ("base", "platform", "grip"))
        yield from ((holder, at, name) for holder, at in _entries(hexapod.get("carries")))


def _entries(written: object) -> Iterator[tuple[list[object], int]]:
    if isinstance(written, list):
        holder = cast("list[object]", written)
        yield from ((holder, at) for at in range(len(holder)))


def _mappings(written: object) -> Iterator[Fields]:
    for holder, at in _entries(written):
        if isinstance(holder[at], dict):
            yield cast("Fields", holder[at])

"""Where a cell or module document names its own items: what stands in a frame, is docked to a connector, has a label.

Everything works on plain data that may be wrong in any way; what is not as it should be names nothing.
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

    holder: Fields
    key: str
    by: str
    is_key: bool = False

    def rename(self, name: str) -> None:
        """Write another name here; keys keep their order."""
        if not self.is_key:
            self.holder[self.key] = name
            return
        rename_key(self.holder, self.key, name)


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

    def is_meant(written: object) -> bool:
        return written == name or (below is not None and isinstance(written, str) and written.startswith(below))

    if section in _FRAME_SECTIONS:
        for holder, key, by in _frame_places(data):
            if is_meant(holder[key]):
                yield NameInUse(holder, key, by)
    if section == "connectors":
        for module, item in items_in(data, "modules"):
            if item.get("connector") == name:
                yield NameInUse(item, "connector", module)
    if section in ("parts", "fixtures", "modules"):
        for bond, item in items_in(data, "bonds"):
            yield from (NameInUse(item, key, bond) for key in ("part", "to") if is_meant(item.get(key)))
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

"""The edits of a cell or module document, as frozen messages with the tag `edit`."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from engine.document.placement import Name

CellSection = Literal[
    "robots",
    "equipment",
    "fixtures",
    "parts",
    "cameras",
    "frames",
    "connectors",
    "modules",
    "devices",
    "bonds",
]
WrittenName = Annotated[str, Meta(min_length=1, max_length=200, description="A name as it is in the document")]
FieldStep = Annotated[str, Meta(min_length=1, max_length=64)]
FieldPath = Annotated[
    tuple[FieldStep, ...], Meta(min_length=1, max_length=6, description="From the item inward: `at`, `xyz`")
]


class CellEdit(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="edit"):
    """Base class of the edits; `section` is a key of the document, `name` that of an item in it."""

    section: CellSection


class AddCellItem(CellEdit, frozen=True, kw_only=True, tag="add_item"):
    """Add an item at the end of a section, which is written if the document has none."""

    name: Name
    value: dict[str, object]


class RemoveCellItem(CellEdit, frozen=True, kw_only=True, tag="remove_item"):
    """Remove an item that nothing else in the document names."""

    name: WrittenName


class RenameCellItem(CellEdit, frozen=True, kw_only=True, tag="rename_item"):
    """Rename an item, with all that names it in the document."""

    name: WrittenName
    new_name: Name


class SetCellField(CellEdit, frozen=True, kw_only=True, tag="set_field"):
    """Set a field of an item; null removes it, so that its default applies.

    Of a list and of a mapping only what differs is written: the other values keep their spelling.
    """

    name: WrittenName
    field: FieldPath
    value: object


class RenameCellField(CellEdit, frozen=True, kw_only=True, tag="rename_field"):
    """Rename an axis, belt, sensor or position of a device, with all that names it in the document."""

    name: WrittenName
    field: Annotated[tuple[FieldStep, FieldStep], Meta(description="Such as `sensors`, `shut`")]
    new_name: Name


AnyCellEdit = AddCellItem | RemoveCellItem | RenameCellItem | SetCellField | RenameCellField

"""Applies edits to the text of a cell or module document atomically: all of them or none."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

from engine.document.cell_frames import WORLD
from engine.editing.cells.cell_draft import CellDraft
from engine.editing.cells.cell_edit import (
    AddCellItem,
    AnyCellEdit,
    CellSection,
    RemoveCellItem,
    RenameCellField,
    RenameCellItem,
    SetCellField,
)
from engine.editing.cells.cell_names_in_use import (
    Fields,
    fields_in,
    rename_key,
    sections_beside,
    uses_in_devices,
    uses_of,
)
from engine.editing.edits.apply import EditRefusal
from engine.editing.text.draft import Draft, EditRefused
from engine.errors import DocumentError
from engine.wording import did_you_mean

_RESERVED = (WORLD, "occupancy")
# The order in which documents have their sections; a new one is written after those before it.
_ORDER = (
    *("flexcell", "cell", "module", "description", "store", "world", "robots", "equipment", "connectors", "modules"),
    *("fixtures", "parts", "frames", "cameras", "devices", "bonds"),
)
# What is nothing when it is empty; `detect: {}` says something.
_NOTHING_WHEN_EMPTY = frozenset(("at", "jitter", "base", "gripper", "axes", "belts", "sensors"))


@dataclass(frozen=True, kw_only=True)
class CellEditAnswer:
    """A text after edits, with what it says; the text as it was if an edit was refused."""

    draft: CellDraft
    refused: EditRefusal | None = None


def apply_cell_edits(text: str, edits: Sequence[AnyCellEdit], *, file: str) -> tuple[str, EditRefusal | None]:
    """Apply edits in order; if one fails, the text stays unchanged.

    Args:
        text: YAML, or JSON if `file` ends in `.json`.
        edits: The edits to apply.
        file: Name of the document, for positions.
    """
    at = 0
    try:
        draft = Draft(text, file=file)
        for at, each in enumerate(edits):  # noqa: B007 - also needed where one fails
            _apply(draft.data, each)
        return draft.text(), None
    except (EditRefused, DocumentError) as error:
        return text, EditRefusal(message=error.message, hint=error.hint or "", index=at)


def _apply(data: Fields, edit: AnyCellEdit) -> None:
    match edit:
        case AddCellItem():
            _require_free(data, edit.section, edit.name)
            _section(data, edit.section)[edit.name] = copy.deepcopy(edit.value)
        case RemoveCellItem():
            items = _items_with(data, edit.section, edit.name)
            users = sorted({each.by for each in uses_of(data, edit.section, edit.name) if each.by != edit.name})
            if users:
                shown = ", ".join(f"`{each}`" for each in users)
                hint = "change or remove these first"
                raise EditRefused(f"`{edit.name}` cannot be removed: it is named by {shown}", hint=hint)
            del items[edit.name]
        case RenameCellItem():
            items = _items_with(data, edit.section, edit.name)
            if edit.name == edit.new_name:
                return
            _require_free(data, edit.section, edit.new_name)
            for use in list(uses_of(data, edit.section, edit.name)):
                use.rename(edit.new_name + use.written[len(edit.name) :])
            rename_key(items, edit.name, edit.new_name)
        case SetCellField():
            item = _items_with(data, edit.section, edit.name)[edit.name]
            if not isinstance(item, dict):
                raise EditRefused(f"`{edit.name}` has no fields", hint="edit the text")
            _set_field(cast("Fields", item), edit.field, edit.value)
        case RenameCellField(field=(group, key)):
            item = _items_with(data, edit.section, edit.name)[edit.name]
            entries = fields_in(item, group)
            if edit.section != "devices" or key not in entries:
                raise EditRefused(f"`{edit.name}` has no `{key}` in `{group}`", hint="select the item again")
            if key == edit.new_name:
                return
            if edit.new_name in entries:
                raise EditRefused(f"`{edit.new_name}` is already in `{group}`", hint="choose another name")
            for use in list(uses_in_devices(data, edit.name, group, key)):
                use.rename(edit.new_name)
            rename_key(entries, key, edit.new_name)


def _set_field(item: Fields, field: Sequence[str], value: object) -> None:
    first, *rest = field
    old = item.get(first)
    if rest:
        if old is None and value is None:
            return
        if old is not None and not isinstance(old, dict):
            raise EditRefused(f"`{first}` has no fields", hint="edit the text")
        fields: Fields = cast("Fields", old) if isinstance(old, dict) else {}
        _set_field(fields, rest, value)
        if fields or first not in _NOTHING_WHEN_EMPTY:
            item[first] = fields
        else:
            item.pop(first, None)
    elif value is None:
        item.pop(first, None)
    else:
        item[first] = _merged(old, value)


def _merged(old: object, new: object) -> object:
    """Return the new value, with the old objects where they stay, so that they keep their text."""
    match old, new:
        case dict(), dict():
            was, fields = cast("Fields", old), cast("Fields", new)
            for key in [key for key in was if key not in fields]:
                del was[key]
            was.update({key: _merged(was.get(key), value) for key, value in fields.items()})
            return was
        case list(), list():
            items, values = cast("list[object]", old), cast("list[object]", new)
            if len(items) != len(values):
                return copy.deepcopy(values)
            items[:] = [_merged(item, value) for item, value in zip(items, values, strict=True)]
            return items
        case ((int() | float()), (int() | float())) if not isinstance(old, bool) and not isinstance(new, bool):
            # `1.0` stays `1.0` where a browser has said 1, and 2 is written as `2.0` in its place.
            return old if old == new else type(old)(new) if type(old) is float else new
        case _:
            return copy.deepcopy(new)


def _require_free(data: Fields, section: CellSection, name: str) -> None:
    for other in sections_beside(section):
        if name in fields_in(data, other):
            raise EditRefused(f"`{name}` is already a name in `{other}`", hint="choose another name")
    if name in _RESERVED:
        raise EditRefused(f"`{name}` has a meaning of its own", hint="choose another name")


def _items_with(data: Fields, section: CellSection, name: str) -> Fields:
    """Return the items of a section, which has this one."""
    items = fields_in(data, section)
    if name not in items:
        hint = did_you_mean(name, items) or "the text may have changed; select the item again"
        raise EditRefused(f"`{section}` has no `{name}`", hint=hint)
    return items


def _section(data: Fields, section: CellSection) -> Fields:
    """Return the items of a section; a missing one is put in its place among the others."""
    if data.get(section) is not None:
        items = data[section]
        if not isinstance(items, dict):
            raise EditRefused(f"`{section}` is no mapping", hint="edit the text")
        return cast("Fields", items)
    made: Fields = {}
    data.pop(section, None)
    before = _ORDER[: _ORDER.index(section)]
    at = max((number for number, key in enumerate(data, 1) if key in before), default=len(data))
    entries = list(data.items())
    data.clear()
    data.update([*entries[:at], (section, made), *entries[at:]])
    return made

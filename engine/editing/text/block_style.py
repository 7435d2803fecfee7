"""Which values are written in block style: nodes of a behavior, and what is easier to read line by line."""

from __future__ import annotations

from typing import cast

from engine.document.canvas_note import CanvasNote
from engine.document.nodes.node_kind import KINDS
from engine.document.nodes.node_spec import TREE_KINDS
from engine.editing.text.syntax import Collection

_NODES = frozenset((*KINDS, *TREE_KINDS))
# Each item of a cell has one of these.
_OF_ITEMS = frozenset(("at", "base", "model", "module"))
_OF_NOTES = frozenset(CanvasNote.__struct_fields__)


def has_node(value: object) -> bool:
    """Return whether a value is, or contains, a node of a behavior: nodes are written in block style."""
    if isinstance(value, list):
        return any(has_node(each) for each in cast("list[object]", value))
    if not isinstance(value, dict):
        return False
    found = cast("dict[str, object]", value)
    return any((key in _NODES and _is_kind(key, each)) or has_node(each) for key, each in found.items())


def lists_mappings(value: object) -> bool:
    """Return whether a value is a list of mappings, such as conditions, which is easier to read line by line."""
    return isinstance(value, list) and any(
        isinstance(each, dict) and each != {} for each in cast("list[object]", value)
    )


def holds_notes(value: object) -> bool:
    """Return whether a value holds notes of the canvas, of which each has a line of its own."""
    return isinstance(value, dict) and any(
        isinstance(each, dict) and (each.keys() == _OF_NOTES or holds_notes(cast("object", each)))
        for each in cast("dict[str, object]", value).values()
    )


def holds_items(value: object) -> bool:
    """Return whether a value is a section of a cell document, of which each item has a line of its own."""
    return isinstance(value, dict) and all(
        isinstance(each, dict) and not _OF_ITEMS.isdisjoint(cast("dict[str, object]", each))
        for each in cast("dict[str, object]", value).values()
    )


def had_node(source: Collection) -> bool:
    """Return whether a collection contained a node before."""
    return any(
        (member.key is not None and member.key.value in _NODES)
        or (isinstance(member.value, Collection) and had_node(member.value))
        for member in source.entries
    )


def _is_kind(key: str, value: object) -> bool:
    return isinstance(value, str) if key in ("state", "behavior", "behaviour") else isinstance(value, dict | list)


def collections_in_flow(source: Collection) -> bool | None:
    """Return whether the collections in a collection are in flow style; None if there are none."""
    found = [member.value for member in source.entries if isinstance(member.value, Collection) and member.value.entries]
    return all(each.flow for each in found) if found else None

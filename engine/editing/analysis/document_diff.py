"""Compares two versions of a document node by node, for a visual diff."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

from engine.editing.text.draft import Draft
from engine.editing.text.outline import NodeRef, Outline, Plain, child_entries

Change = Literal["added", "removed", "changed", "moved"]
DOCUMENT_PATH = "document"
_CANVAS_NOTES = "canvas_notes"


@dataclass(frozen=True, kw_only=True)
class FieldChange:
    """One field that differs; None on the side on which it does not exist."""

    field: str
    before: object
    after: object


@dataclass(frozen=True, kw_only=True)
class NodeChange:
    """A node that was added, removed, changed, or moved to another container or name, and possibly changed.

    The path `document` stands for the document itself. `before_path` is the previous path of a moved node.
    """

    path: str
    change: Change
    before_path: str | None = None
    fields: tuple[FieldChange, ...] = ()


@dataclass(frozen=True, kw_only=True)
class DocumentDiff:
    """All changes, those of the document first; `layout_only` when only positions on the canvas differ."""

    changes: tuple[NodeChange, ...]
    layout_only: bool


def compare_texts(before: str, after: str, *, file: str) -> DocumentDiff:
    """Compare two versions of a document.

    Raises:
        DocumentError: one of them cannot be read.
    """
    old, new = Draft(before, file=file).data, Draft(after, file=file).data
    fields = _fields(_declared(old), _declared(new))
    changes = [NodeChange(path=DOCUMENT_PATH, change="changed", fields=fields)] if fields else []
    nodes = _compare(Outline(old), Outline(new))
    layout_only = bool(fields) and not nodes and all(_is_layout(each.field) for each in fields)
    return DocumentDiff(changes=(*changes, *nodes), layout_only=layout_only)


def _declared(document: Plain) -> Plain:
    """Return what stands beside the nodes; each field of a note on the canvas by itself."""
    found: Plain = {}
    for key, value in document.items():
        if key == _CANVAS_NOTES and isinstance(value, dict):
            found |= _flat(key, cast("Plain", value), depth=3)
        elif key != "root":
            found[key] = value
    return found


def _flat(head: str, mapping: Plain, depth: int) -> Plain:
    found: Plain = {}
    for key, value in mapping.items():
        name = f"{head}.{key}"
        found |= (
            _flat(name, cast("Plain", value), depth - 1) if depth > 1 and isinstance(value, dict) else {name: value}
        )
    return found


def _is_layout(field: str) -> bool:
    return field == "view" or (field.startswith(f"{_CANVAS_NOTES}.") and field.endswith((".position", ".size")))


def _compare(old: Outline, new: Outline) -> list[NodeChange]:
    gone = {path: ref for path, ref in old.refs.items() if path not in new.refs}
    fresh = {path: ref for path, ref in new.refs.items() if path not in old.refs}
    moved = _moved(gone, fresh)
    changes: list[NodeChange] = []
    for path, ref in new.refs.items():
        if path in fresh:
            origin = next((was for was, now in moved.items() if now == path), None)
            kind: Change = "moved" if origin is not None else "added"
            changes.append(NodeChange(path=path, change=kind, before_path=origin))
            continue
        fields = _fields(_own(old.refs[path]), _own(ref))
        if fields:
            changes.append(NodeChange(path=path, change="changed", fields=fields))
    changes += [NodeChange(path=path, change="removed") for path in gone if path not in moved]
    return changes


def _moved(gone: dict[str, NodeRef], fresh: dict[str, NodeRef]) -> dict[str, str]:
    """Return the nodes that exist unchanged elsewhere: equal except for their targets."""
    found: dict[str, str] = {}
    for was, ref in gone.items():
        alike = (path for path, now in fresh.items() if path not in found.values() and _essence(now) == _essence(ref))
        now = next(alike, None)
        if now is not None:
            found[was] = now
    return found


def _essence(ref: NodeRef) -> object:
    return {key: value for key, value in ref.data.items() if key not in ("transitions", "name")}


def _own(ref: NodeRef) -> Plain:
    """Return the fields of a node without its children, flattened: `with.speed`, `machine.initial`."""
    inside = {id(child) for _, _, child in child_entries(ref.data)}
    own: Plain = {}
    for key, value in ref.data.items():
        if isinstance(value, dict) and key != "tree":
            for name, each in cast("Plain", value).items():
                if name == "states" and isinstance(each, dict):
                    own[f"{key}.order"] = list(cast("Plain", each))
                elif name == "children" and isinstance(each, list):
                    own[f"{key}.order"] = [name for name, _, _ in child_entries(ref.data)]
                elif id(each) not in inside:
                    own[f"{key}.{name}"] = each
        elif isinstance(value, list) and any(id(each) in inside for each in cast("list[object]", value)):
            own[f"{key}.order"] = [name for name, _, _ in child_entries(ref.data)]
        elif key != "tree":
            own[key] = value
    own["kind"] = ref.kind
    return own


def _fields(old: Plain, new: Plain) -> tuple[FieldChange, ...]:
    names = dict.fromkeys((*old, *new))
    return tuple(
        FieldChange(field=name, before=old.get(name), after=new.get(name))
        for name in names
        if old.get(name) != new.get(name) or (name in old) != (name in new)
    )

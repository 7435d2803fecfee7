"""Edits of the fields of a node or document: parameters, policies, texts, positions, declarations."""

from __future__ import annotations

import json
import math
from typing import cast

import msgspec

from engine.document.behavior import BehaviorDocument
from engine.document.nodes.node_kind import GROUPS, NAMED, SLOTS
from engine.document.nodes.node_kinds import NODE_KINDS
from engine.document.nodes.node_spec import NodeSpec
from engine.editing.edits.edit import ClearParameter, SetDocument, SetField, SetParameter, SetPositions
from engine.editing.edits.edit_session import EditSession, assign_child_roles, named_children, remove_entry
from engine.editing.text.draft import EditRefused
from engine.editing.text.node_matching import graft
from engine.editing.text.outline import NodeRef, Plain
from engine.wording.misfit import explain_misfit
from engine.wording.suggestions import did_you_mean

_OF_NODES = frozenset(
    ("description", "timeout", "retry", "guard", "on_error", "autonomy", "resume", "in", "out", "success", "every",
     "post", "state", "behavior", "behaviour", "name", "disabled")
)  # fmt: skip
_FARTHEST_PX = 1_000_000
_INSIDE = frozenset(("states", "child", "children", *SLOTS["if_then_else"], *SLOTS["while_do_else"]))
_OF_DOCUMENTS = ("name", "description", "cell", "parameters", "userdata", "outcomes", "success")
_HEAD = (
    "flexcell",
    *_OF_DOCUMENTS[:2],
    "cell",
    "parameters",
    "userdata",
    "outcomes",
    "success",
    "root",
    "view",
    "notes",
    "canvas_notes",
)
_ORDER = (
    "description", "name", "state", "behavior", "behaviour", "with", "in", "out", "guard", "post", "timeout", "retry",
    "on_error", "autonomy", "resume", "success", "every", "disabled", "transitions",
)  # fmt: skip
"""Order in which the keys of a state are written."""
_ORDER_INSIDE = (
    "initial", "items", "times", "as", "index", "memory", "policy", "synchronise", "success_count", "failure_count",
)  # fmt: skip


def set_parameter(session: EditSession, edit: SetParameter) -> None:
    """Set a parameter of a state or behavior."""
    ref = session.at(edit.path)
    if "state" not in ref.data and "behavior" not in ref.data and "behaviour" not in ref.data:
        raise EditRefused(
            f"`{ref.path}` takes no parameters", hint="only states and behavior references take parameters"
        )
    set_entry(ref.data, "with", {**_mapping(ref.data.get("with")), edit.name: plain_value(edit.value)})
    session.mark(ref.data)


def clear_parameter(session: EditSession, edit: ClearParameter) -> None:
    """Remove the value of a parameter."""
    ref = session.at(edit.path)
    given = _mapping(ref.data.get("with"))
    if edit.name not in given:
        raise EditRefused(f"`{ref.path}` has no value for `{edit.name}`", hint=did_you_mean(edit.name, given))
    remove_entry(ref.data, "with", edit.name)
    session.mark(ref.data)


def set_field(session: EditSession, edit: SetField) -> None:
    """Set one field of a node."""
    ref = session.at(edit.path)
    value = plain_value(edit.value)
    if edit.field == "order":
        _reorder(session, ref, value)
    elif edit.field == "notes":
        _note(session, ref, value)
    elif edit.field in _OF_NODES and not (edit.field == ref.kind and ref.kind in NODE_KINDS):
        _set_own(ref, edit.field, value)
    else:
        _set_inside(ref, edit.field, value)
    session.mark(ref.data)
    session.stale()


def set_positions(session: EditSession, edit: SetPositions) -> None:
    """Set the canvas positions of nodes."""
    view = _mapping(session.draft.data.get("view"))
    for path, point in edit.positions.items():
        ref = session.at(path)
        if point is None:
            view.pop(path, None)
        else:
            at = [rounded(number) for number in point]
            view[path] = graft(view[path], at) if path in view else at
            session.mark(ref.data)
    if view:
        session.draft.data["view"] = view
    else:
        session.draft.data.pop("view", None)


def set_document(session: EditSession, edit: SetDocument) -> None:
    """Change declarations of the document."""
    for key, value in edit.changes.items():
        if key not in _OF_DOCUMENTS:
            raise EditRefused(f"a document has no `{key}` to set", hint=did_you_mean(key, _OF_DOCUMENTS))
        if value is None:
            session.draft.data.pop(key, None)
            continue
        _require(BehaviorDocument, key, value)
        data = session.draft.data
        if key in data:
            data[key] = graft(data[key], plain_value(value))
        else:
            _insert_in_order(data, key, plain_value(value), _HEAD)


def set_entry(node: Plain, key: str, value: object) -> None:
    """Set an entry of a node; a new one is inserted at its conventional position."""
    if key in node:
        node[key] = graft(node[key], value)
    elif key == "description":
        kept = dict(node)
        node.clear()
        node.update({key: value, **kept})
    elif key in ("with", "in", "out", "disabled") and "transitions" in node:
        _insert_in_order(node, key, value, _ORDER)
    else:
        node[key] = value


def plain_value(value: object, depth: int = 0) -> object:
    """Return a value of a request as plain data; rejects values that are nested too deeply."""
    if depth > 40:
        raise EditRefused("this value is nested too deeply", hint="the maximum is 40 levels")
    if isinstance(value, dict):
        return {str(key): plain_value(each, depth + 1) for key, each in cast("dict[object, object]", value).items()}
    if isinstance(value, list | tuple):
        return [plain_value(each, depth + 1) for each in cast("list[object]", value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise EditRefused("this is not a finite number")
    if isinstance(value, int) and not isinstance(value, bool) and not -(2**63) <= value < 2**63:
        raise EditRefused("this integer does not fit into 64 bits")
    return value


def _set_own(ref: NodeRef, key: str, value: object) -> None:
    if value is None or value == {} or (key == "description" and value == "") or (key == "disabled" and not value):
        if key in ("state", "behavior", "behaviour"):
            raise EditRefused(
                "this field is what the node executes and cannot be removed", hint="remove the node instead"
            )
        ref.data.pop(key, None)
        return
    if key in ("state", "behavior", "behaviour") and key not in ref.data:
        raise EditRefused(
            f"`{ref.path}` is a {ref.kind or 'node without kind'}, no {key}", hint="add a new node instead"
        )
    _require(NodeSpec, key, value)
    set_entry(ref.data, key, value)


def _set_inside(ref: NodeRef, key: str, value: object) -> None:
    model = NODE_KINDS[ref.kind].model if ref.kind in NODE_KINDS else None
    known = {each.encode_name for each in msgspec.structs.fields(model)} - _INSIDE if model is not None else set[str]()
    if model is None or key not in known:
        raise EditRefused(
            f"a {ref.kind or 'node'} has no `{key}` to set",
            where=ref.path,
            hint=did_you_mean(key, {*known, *_OF_NODES}),
        )
    if value is not None:
        _require(model, key, value)
    elif key == "initial":
        raise EditRefused("a machine requires an initial child", where=ref.path, hint="name one of its children")
    body = _body(ref)
    if value is None:
        body.pop(key, None)
    elif key in body:
        body[key] = graft(body[key], value)
    else:
        _insert_in_order(body, key, value, _ORDER_INSIDE)


def _body(ref: NodeRef) -> Plain:
    """Return the mapping under the key of a node's kind; a plain list of children is converted to one."""
    body = ref.data.get(ref.kind)
    if isinstance(body, list):
        memory = {"memory": True} if ref.kind != "parallel" else {}
        ref.data[ref.kind] = {**memory, "children": cast("list[object]", body)}
    elif not isinstance(body, dict):
        ref.data[ref.kind] = {}
    return cast("Plain", ref.data[ref.kind])


def _reorder(session: EditSession, ref: NodeRef, value: object) -> None:
    children = session.outline.children(ref)
    order = [str(name) for name in cast("list[object]", value)] if isinstance(value, list) else []
    if sorted(order) != sorted(child.name for child in children):
        names = ", ".join(child.name for child in children)
        raise EditRefused("an order must name each child once", where=ref.path, hint=f"its children are {names}")
    by_name = {child.name: child for child in children}
    if ref.kind in NAMED:
        states = named_children(ref)
        left = {key: each for key, each in states.items() if key not in by_name}
        states.clear()
        states.update({**{name: by_name[name].data for name in order}, **left})
    elif ref.kind in GROUPS:
        listed = ref.data[ref.kind]
        items = cast("list[object]", listed if isinstance(listed, list) else cast("Plain", listed)["children"])
        items[:] = [by_name[name].data for name in order]
    elif ref.kind in SLOTS:
        assign_child_roles(ref, [by_name[name].data for name in order])


def _note(session: EditSession, ref: NodeRef, value: object) -> None:
    notes = _mapping(session.draft.data.get("notes"))
    if value is None or value == "":
        notes.pop(ref.path, None)
    elif isinstance(value, str):
        notes[ref.path] = value
    else:
        raise EditRefused("a note must be text", where=ref.path)
    if notes:
        session.draft.data["notes"] = notes
    else:
        session.draft.data.pop("notes", None)


def _require(model: type[msgspec.Struct], key: str, value: object) -> None:
    """Reject a value that is invalid for this field of a document."""
    kind = next(each.type for each in msgspec.structs.fields(model) if each.encode_name == key)
    try:
        msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        given = json.dumps(value, default=str)[:80]
        raise EditRefused(explain_misfit(error, kind, key=key), hint=f"given: {given}") from None


def _insert_in_order(mapping: Plain, key: str, value: object, order: tuple[str, ...]) -> None:
    """Insert a new entry after the last entry that precedes it in `order`."""
    rank = order.index(key) if key in order else len(order)
    items = list(mapping.items())
    place = 0
    for number, (name, _) in enumerate(items):
        if name in order and order.index(name) < rank:
            place = number + 1
    if key not in order:
        place = len(items)
    items.insert(place, (key, value))
    mapping.clear()
    mapping.update(items)


def rounded(number: float) -> int | float:
    """Return pixels as they are written, with one digit; rejects what is far off the canvas."""
    if not -_FARTHEST_PX <= number <= _FARTHEST_PX:
        raise EditRefused(f"position out of range: {number:g}", hint=f"positions are within ±{_FARTHEST_PX} pixels")
    near = round(number, 1)
    return int(near) if near == int(near) else near


def _mapping(value: object) -> Plain:
    return cast("Plain", value) if isinstance(value, dict) else {}

"""The edit that gives nodes another type in place: another state or behavior, or another kind of container."""

from __future__ import annotations

import copy
from typing import cast

import msgspec

from engine.document.nodes.node_kind import GROUPS, KINDS, MACHINES, NAMED, SLOTS, WRAPPERS
from engine.document.nodes.node_kinds import NODE_KINDS
from engine.document.nodes.node_spec import TREE_KINDS
from engine.editing.edits.edit import ReplaceType
from engine.editing.edits.edit_session import EditSession, ReferenceUpdate, named_children, remove_entry, rename_key
from engine.editing.edits.node_edits import outermost
from engine.editing.edits.node_insertion import insert_nodes
from engine.editing.edits.type_losses import LossRecord, UnacceptedLosses
from engine.editing.edits.type_signature import TypeSignature, type_signature
from engine.editing.text.draft import EditRefused
from engine.editing.text.outline import NodeRef, Plain
from engine.wording.suggestions import did_you_mean

_LEAVES = ("state", "behavior")
_OF_LEAVES = ("with", "in", "out")
_CHILD_KEYS = frozenset(("states", "child", "children", *SLOTS["if_then_else"], *SLOTS["while_do_else"]))


def replace_type(session: EditSession, edit: ReplaceType) -> None:
    """Give nodes another type in place."""
    if edit.kind not in _LEAVES and edit.kind not in NODE_KINDS:
        raise EditRefused(f"there is no kind `{edit.kind}`", hint=did_you_mean(edit.kind, (*KINDS, *NODE_KINDS)))
    refs = outermost([session.at(path) for path in edit.paths])
    if not refs:
        raise EditRefused("no nodes are selected", hint="select the nodes to replace")
    signature = type_signature(session.context, edit.kind, edit.runs) if edit.kind in _LEAVES else None
    records = [LossRecord(session, ref) for ref in refs]
    for ref in refs:
        _check_place(ref, edit.kind)
    follow = ReferenceUpdate(session)
    for ref, record in zip(refs, records, strict=True):
        if signature is not None:
            _make_leaf(ref, edit, signature, record)
        else:
            _make_container(session, ref, edit.kind)
        _keep_outcomes(session, ref, edit, record)
        session.mark(ref.data)
    follow.finish()
    name = f"`{edit.runs if signature is not None else edit.kind}`"
    losses = tuple(loss for record in records for loss in record.losses(name))
    if not set(losses) <= set(edit.accepted):
        raise UnacceptedLosses(losses)


def _check_place(ref: NodeRef, kind: str) -> None:
    if (kind in TREE_KINDS or kind in WRAPPERS) and not ref.in_tree:
        raise EditRefused(f"a `{kind}` is valid only inside a tree", where=ref.path, hint="choose another type")
    if not ref.kind:
        raise EditRefused(f"`{ref.path}` has no kind", hint="remove the node, and add a new one")
    if kind != ref.kind and kind in ref.data:
        raise EditRefused(f"`{ref.path}` has a `{kind}` already", hint=f"remove its `{kind}` first")


def _make_leaf(ref: NodeRef, edit: ReplaceType, signature: TypeSignature, record: LossRecord) -> None:
    data = ref.data
    rename_key(data, ref.kind, edit.kind)
    data[edit.kind] = edit.runs
    for section in _OF_LEAVES:
        given = data.get(section)
        for name, value in list(cast("Plain", given).items()) if isinstance(given, dict) else ():
            problem = signature.problem(section, name, value)
            if problem is not None:
                record.reasons[id(data), f"{section}.{name}"] = problem
                remove_entry(data, section, name)


def _make_container(session: EditSession, ref: NodeRef, kind: str) -> None:
    if kind == ref.kind:
        return
    data, was = ref.data, ref.kind
    for section in _OF_LEAVES if was in _LEAVES or was == "behaviour" else ():
        data.pop(section, None)
    if (was in MACHINES and kind in MACHINES) or (was in GROUPS and kind in GROUPS):
        _rename_kind(ref, kind)
        return
    children = _children(session, ref, kind)
    body = cast("Plain | list[object]", copy.deepcopy(NODE_KINDS[kind].new))
    if isinstance(body, dict) and kind != "tree":
        body.update({key: value for key, value in ref.body.items() if _fits(kind, key, value)})
        body = _in_old_place(ref, body)
    rename_key(data, was, kind)
    data[kind] = body
    session.stale()
    container = session.at(session.outline.path_of(data))
    if kind == "tree":
        (container,) = session.outline.children(container)
    held = len(children) if container.kind in (*NAMED, *GROUPS) else len(SLOTS.get(kind, ("child",)))
    if children:
        insert_nodes(session, container, dict(list(children.items())[:held]))


def _in_old_place(ref: NodeRef, body: Plain) -> Plain:
    """Return the mapping of the old kind with the content of the new one, so that comments beside both stay."""
    old = ref.body
    if not old or ref.kind == "tree":
        return body
    states = old.get("states")
    old.clear()
    old.update(body)
    if isinstance(states, dict) and "states" in body:
        old["states"] = cast("Plain", states)
    return old


def _rename_kind(ref: NodeRef, kind: str) -> None:
    """Change the key of a container whose children are held in the same form."""
    rename_key(ref.data, ref.kind, kind)
    body = ref.data[kind]
    if not isinstance(body, dict) or kind in NAMED:
        return
    written = cast("Plain", body)
    for key in [key for key in written if key != "children" and not _fits(kind, key, written[key])]:
        del written[key]
    if kind != "parallel":
        written.setdefault("memory", True)


def _children(session: EditSession, ref: NodeRef, kind: str) -> dict[str, Plain]:
    """Take the nodes out of a container that can be in one of another kind, by name."""
    inside = session.outline.children(ref)
    if ref.kind == "tree" and len(inside) == 1 and inside[0].kind in GROUPS:
        inside = session.outline.children(inside[0])
    is_tree = kind == "tree" or NODE_KINDS[kind].only_in_tree
    kept = {child.name: child.data for child in inside if is_tree or not child.is_part}
    if ref.kind in NAMED:
        named_children(ref).clear()
    return kept


def _fits(kind: str, key: str, value: object) -> bool:
    """Return whether a container of a kind has a field, and the field may have this value."""
    model = NODE_KINDS[kind].model
    if model is None or key in _CHILD_KEYS:
        return False
    declared = next((each.type for each in msgspec.structs.fields(model) if each.encode_name == key), None)
    if declared is None:
        return False
    try:
        msgspec.convert(value, declared)
    except msgspec.ValidationError:
        return False
    return True


def _keep_outcomes(session: EditSession, ref: NodeRef, edit: ReplaceType, record: LossRecord) -> None:
    """Remove what names outcomes that the new type does not have; a machine has those that its transitions name."""
    if edit.kind in NAMED:
        return
    session.stale()
    outcomes = session.ends(session.at(session.outline.path_of(ref.data))).outcomes
    data, reason = ref.data, f"`{edit.runs or edit.kind}` has no such outcome"
    for section in ("transitions", "autonomy"):
        given = data.get(section)
        for name in list(cast("Plain", given)) if isinstance(given, dict) else ():
            if name not in outcomes:
                record.reasons[id(data), f"{section}.{name}"] = reason
                remove_entry(data, section, name)
    if edit.kind != "retry" and isinstance(data.get("retry"), dict):
        _keep_named(cast("Plain", data["retry"]), "outcomes", outcomes)
    _keep_named(data, "success", outcomes)
    if isinstance(data.get("resume"), str) and data["resume"] not in ("rerun", "ask", *outcomes):
        record.reasons[id(data), "resume"] = reason
        del data["resume"]
    if isinstance(data.get("disabled"), str) and data["disabled"] not in outcomes:
        # A disabled node must not become enabled by this.
        data["disabled"] = outcomes[0] if outcomes else True


def _keep_named(node: Plain, key: str, outcomes: tuple[str, ...]) -> None:
    """Remove the outcomes of a list that the new type does not have, and the list with its last one."""
    given = node.get(key)
    if not isinstance(given, list):
        return
    listed = cast("list[object]", given)
    kept = [each for each in listed if each in outcomes]
    if not kept:
        # As it is: what is lost is told from it.
        del node[key]
    elif len(kept) < len(listed):
        listed[:] = kept

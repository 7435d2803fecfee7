"""Edits of positions and names of nodes: remove, rename, move."""

from __future__ import annotations

from typing import cast

from engine.document.nodes.node_kind import GROUPS, MACHINES, NAMED, SLOTS
from engine.editing.edits.edit import MoveNodes, RemoveNodes, RenameNode
from engine.editing.edits.edit_session import (
    EditSession,
    ReferenceUpdate,
    assign_child_roles,
    named_children,
    rename_key,
)
from engine.editing.edits.node_insertion import insert_nodes
from engine.editing.text.draft import EditRefused
from engine.editing.text.outline import NodeRef, Plain, own_name


def remove_nodes(session: EditSession, edit: RemoveNodes) -> None:
    """Remove nodes."""
    refs = outermost([session.at(path) for path in edit.paths])
    follow = ReferenceUpdate(session)
    for ref in refs:
        detach_node(ref)
    follow.finish()


def rename_node(session: EditSession, edit: RenameNode) -> None:
    """Rename a node."""
    ref = session.at(edit.path)
    container = ref.parent
    if container is None:
        raise EditRefused("the root node has no name", hint="change the `name` of the document")
    if container.kind == "foreach":
        raise EditRefused("the child of a foreach is always named `child`", where=ref.path)
    if edit.name == ref.name:
        return
    taken = {child.name for child in session.outline.children(container)}
    if edit.name in taken:
        raise EditRefused(f"`{container.path}` has a `{edit.name}` already", hint="choose another name")
    if container.kind in MACHINES and edit.name in session.outcomes_inside(container):
        hint = "a name is either a child or an outcome; choose another name"
        raise EditRefused(f"`{edit.name}` is an outcome of `{container.path}`", hint=hint)
    follow = ReferenceUpdate(session)
    if container.kind in NAMED:
        rename_key(named_children(container), ref.name, edit.name)
    elif own_name({key: value for key, value in ref.data.items() if key != "name"}) == edit.name:
        ref.data.pop("name", None)
    elif "name" in ref.data:
        ref.data["name"] = edit.name
    else:
        kept = dict(ref.data)
        ref.data.clear()
        ref.data.update({"name": edit.name, **kept})
    follow.finish()
    session.mark(ref.data)


def move_nodes(session: EditSession, edit: MoveNodes) -> None:
    """Move nodes to another container, or to another position among their siblings."""
    container = session.at(edit.parent)
    refs = outermost([session.at(path) for path in edit.paths])
    for ref in refs:
        if container.path == ref.path or container.path.startswith(f"{ref.path}/"):
            raise EditRefused(f"`{ref.path}` cannot be moved into itself")
    if all(ref.parent is container for ref in refs):
        _among_siblings(session, container, refs, edit.index)
        return
    _check_stays(session, refs)
    known = set(session.outcomes_inside(container)) if container.kind in MACHINES else set[str]()
    follow = ReferenceUpdate(session)
    wishes: dict[str, Plain] = {}
    for ref in refs:
        number, name = 2, ref.name
        while name in wishes:
            name, number = f"{ref.name}_{number}", number + 1
        wishes[name] = ref.data
        detach_node(ref)
    session.stale()
    home = session.at(session.outline.path_of(container.data))
    leading = {id(ref.data): _leads_of(ref.data) for ref in refs}
    insert_nodes(session, home, wishes, index=edit.index)
    for ref in refs:
        # What `insert_nodes` has renamed among them is found by identity below.
        _restore(ref.data, leading[id(ref.data)])
        session.mark(ref.data)
    follow.finish(dangling=lambda _, target: target if target in known else None)


def detach_node(ref: NodeRef) -> None:
    """Remove a node from its container; references to it are unchanged."""
    container = ref.parent
    if container is None:
        raise EditRefused("the root node cannot be removed", hint="delete the document instead")
    if container.kind in NAMED:
        named_children(container).pop(ref.name, None)
    elif container.kind in GROUPS:
        body = container.data[container.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[:] = [each for each in listed if each is not ref.data]
    elif container.kind == "tree":
        container.data["tree"] = {}
    else:
        container.body.pop(ref.role or "child", None)


def outermost(refs: list[NodeRef]) -> list[NodeRef]:
    """Drop nodes that are inside others of the list, and duplicates."""
    found: dict[str, NodeRef] = {ref.path: ref for ref in refs}
    return [
        ref for path, ref in found.items() if not any(path.startswith(f"{other}/") for other in found if other != path)
    ]


def _among_siblings(session: EditSession, container: NodeRef, refs: list[NodeRef], index: int | None) -> None:
    moved = {id(ref.data) for ref in refs}
    rest = [child for child in session.outline.children(container) if id(child.data) not in moved]
    place = len(rest) if index is None else max(0, min(index, len(rest)))
    order = [*rest[:place], *refs, *rest[place:]]
    follow = ReferenceUpdate(session)
    if container.kind in NAMED:
        states = named_children(container)
        left = {key: each for key, each in states.items() if not any(child.name == key for child in order)}
        states.clear()
        states.update({**{child.name: child.data for child in order}, **left})
    elif container.kind in GROUPS:
        body = container.data[container.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[:] = [child.data for child in order]
    elif container.kind in SLOTS:
        assign_child_roles(container, [child.data for child in order])
    follow.finish()
    for ref in refs:
        session.mark(ref.data)


def _check_stays(session: EditSession, refs: list[NodeRef]) -> None:
    for ref in refs:
        if ref.parent is None:
            raise EditRefused("the root node cannot be moved")
    del session


def _leads_of(node: Plain) -> dict[str, object]:
    wired = node.get("transitions")
    return dict(cast("Plain", wired)) if isinstance(wired, dict) else {}


def _restore(node: Plain, transitions: dict[str, object]) -> None:
    wired = node.get("transitions")
    if isinstance(wired, dict):
        cast("Plain", wired).update({key: to for key, to in transitions.items() if key in wired})

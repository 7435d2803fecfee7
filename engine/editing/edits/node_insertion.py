"""Edits that insert nodes into a container: new nodes, copies, and nodes from a clipboard."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import cast

from engine.document.nodes.node_kind import GROUPS, KINDS, MACHINES, NAMED, SLOTS, WRAPPERS
from engine.document.nodes.node_kinds import NODE_KINDS
from engine.document.nodes.node_spec import GUARD_TARGETS, TREE_KINDS
from engine.editing.edits.edit import AddNode, CanvasPoint, DuplicateNodes, PasteNodes, SetPositions, TransitionRef
from engine.editing.edits.edit_session import NAME, EditSession, ReferenceUpdate, insert_key, named_children
from engine.editing.edits.field_edits import plain_value, set_positions
from engine.editing.edits.transition_edits import connect, unconnected_outcomes, write_initial
from engine.editing.text.draft import EditRefused
from engine.editing.text.indentation import indent_text
from engine.editing.text.outline import NodeRef, Plain, kind_of, own_name, transition_entries, tree_names
from engine.editing.text.text_rewriter import TextRewriter, WritePosition
from engine.editing.text.yaml_style import key_text
from engine.errors import DocumentError
from engine.wording.suggestions import did_you_mean

_RUNNING = ("state", "behavior", "behaviour")
_STEP_PX = 40


def add_node(session: EditSession, edit: AddNode) -> None:
    """Insert a new node into a container."""
    if edit.yaml:
        paste(session, PasteNodes(parent=edit.parent, yaml=edit.yaml, position=edit.position, index=edit.index))
        return
    container = session.at(edit.parent)
    node = _new_node(edit)
    index = edit.index
    after = (
        session.at(edit.on_edge.source) if edit.on_edge is not None else session.at(edit.after) if edit.after else None
    )
    if after is not None:
        if after.parent is None or after.parent.data is not container.data:
            raise EditRefused(f"`{after.path}` is not in `{container.path}`", hint="name a child of that container")
        index = (
            [child.name for child in session.outline.children(container)].index(after.name) + 1
            if index is None
            else index
        )
    _check_edge(session, container, edit.on_edge)
    tree = container.kind == "tree" or container.is_part
    name = edit.name or (own_name(node) if tree else snake_case(edit.runs or edit.kind))
    if edit.name is not None and edit.name in [child.name for child in session.outline.children(container)]:
        raise EditRefused(f"`{container.path}` has a `{edit.name}` already", hint="choose another name")
    insert_nodes(session, container, {name: node}, index=index, named=edit.name is not None)
    ref = session.at(session.outline.path_of(node))
    if edit.on_edge is not None and after is not None:
        _into_edge(session, ref, edit.on_edge, session.at(session.outline.path_of(after.data)))
    elif after is not None and container.kind in MACHINES:
        good = session.ends(after).success
        for outcome in unconnected_outcomes(session, after):
            if outcome in good:
                connect(session, after, outcome, ref.name)
    if edit.position is not None:
        set_positions(session, SetPositions(positions={ref.path: edit.position}))
    session.mark(node)


def duplicate(session: EditSession, edit: DuplicateNodes) -> None:
    """Insert copies of nodes next to them."""
    refs = [session.at(path) for path in edit.paths]
    for ref in refs:
        if ref.parent is None or (ref.parent.kind not in NAMED and ref.parent.kind not in GROUPS):
            raise EditRefused(
                f"`{ref.path}` is in a container with one child only", hint="duplicate it inside another container"
            )
    for home in {id(ref.parent): ref.parent for ref in refs if ref.parent is not None}.values():
        mine = [ref for ref in refs if ref.parent is home]
        view = cast("Plain", session.draft.data.get("view") or {})
        points = {ref.path: view[ref.path] for ref in mine if ref.path in view}
        copies = {ref.name: cast("Plain", session.draft.copied(ref.data)) for ref in mine}
        last = max([child.name for child in session.outline.children(home)].index(ref.name) for ref in mine)
        insert_nodes(session, session.at(session.outline.path_of(home.data)), copies, index=last + 1)
        for ref in mine:
            node = copies[ref.name]
            session.mark(node)
            if ref.path in points:
                x, y = cast("list[float]", points[ref.path])
                positions: dict[str, CanvasPoint | None] = {session.outline.path_of(node): (x + _STEP_PX, y + _STEP_PX)}
                set_positions(session, SetPositions(positions=positions))


def paste(session: EditSession, edit: PasteNodes) -> None:
    """Insert nodes from a clipboard into a container."""
    container = session.at(edit.parent)
    try:
        pasted = session.draft.adopt(edit.yaml)
    except DocumentError as error:
        raise EditRefused(f"this is not a copy of nodes: {error.message}", hint=error.hint) from error
    for name, node in pasted.items():
        kind = kind_of(cast("Plain", node), in_tree=True) if isinstance(node, dict) else ""
        if not kind or not NAME.fullmatch(name):
            raise EditRefused(f"`{name}` is not a node", hint="paste the result of `copy`: names and their nodes")
    if not pasted:
        raise EditRefused("there is nothing to paste", hint="copy some nodes first")
    nodes = {name: cast("Plain", node) for name, node in pasted.items()}
    insert_nodes(session, container, nodes, index=edit.index, foreign=True)
    positions: dict[str, CanvasPoint | None] = {}
    for number, node in enumerate(nodes.values()):
        session.mark(node)
        if edit.position is not None:
            shift = number * _STEP_PX
            positions[session.outline.path_of(node)] = (edit.position[0] + shift, edit.position[1] + shift)
    if positions:
        set_positions(session, SetPositions(positions=positions))


def insert_nodes(
    session: EditSession,
    container: NodeRef,
    nodes: dict[str, Plain],
    *,
    index: int | None = None,
    named: bool = False,
    foreign: bool = False,
) -> None:
    """Insert detached nodes into a container, under free names, and adapt them to it.

    Args:
        session: The session.
        container: The container.
        nodes: The nodes by preferred name; transitions among them are updated.
        index: Position of the first node; by default the end.
        named: Whether the names were requested, so that they are written even if they are the default.
        foreign: Whether the nodes may come from another behavior, so that their targets are unknown.
    """
    _check_room(container, nodes)
    names: dict[str, str] = {}
    for name in nodes:
        names[name] = session.free_name(container, name, names.values())
    for node in nodes.values():
        drop_unsupported_keys(container, node)
    known: set[str] | None = None
    if foreign and container.kind in MACHINES:
        known = {child.name for child in session.outline.children(container)} | {*session.outcomes_inside(container)}
    if container.kind in NAMED:
        states = named_children(container)
        for number, (name, node) in enumerate(nodes.items()):
            insert_key(states, names[name], node, None if index is None else index + number)
    else:
        _put_in_tree(session, container, nodes, names, index, named=named)
    session.stale()
    if container.kind in MACHINES:
        _rewire(session, container, nodes, names, known)
    for node in nodes.values():
        _keep_disabled(session, container, node)


def drop_unsupported_keys(container: NodeRef, node: Plain) -> None:
    """Remove the fields of a node that are invalid in a container of this kind."""
    tree = container.kind == "tree" or container.is_part
    kind = kind_of(node, in_tree=True)
    if not tree:
        if kind in TREE_KINDS or kind in WRAPPERS:
            raise EditRefused(f"a `{kind}` is valid only inside a tree", hint="insert it into a `tree`")
        node.pop("name", None)
        node.pop("success", None)
        node.pop("post", None)
    if container.kind not in MACHINES:
        node.pop("transitions", None)
    if tree:
        for measure in ("timeout", "guard"):
            found = node.get(measure)
            if measure != kind and isinstance(found, dict) and "child" not in found:
                guarded = cast("Plain", found)
                if measure != "guard" or guarded.get("to") not in GUARD_TARGETS:
                    guarded["to"] = "failure"
        if isinstance(node.get("on_error"), str):
            node["on_error"] = "failure"


def _keep_disabled(session: EditSession, container: NodeRef, node: Plain) -> None:
    """Let a disabled node be passed over as this container does it: with an outcome, or skipped in a tree."""
    if not node.get("disabled"):
        return
    if container.kind == "tree" or container.is_part:
        node["disabled"] = True
    elif node["disabled"] is True:
        ends = session.ends(session.at(session.outline.path_of(node)))
        outcome = next(iter((*ends.success, *ends.outcomes)), None)
        node["disabled"] = outcome or True


def snake_case(runs: str) -> str:
    """Return a name for what a node executes: `motion.MoveJoints` is `move_joints`, `sub/pick.yaml` is `pick`."""
    last = PurePosixPath(runs).stem if runs.endswith((".yaml", ".yml", ".json")) else re.split(r"[.:/]", runs)[-1]
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", last).lower()


def _new_node(edit: AddNode) -> Plain:
    if edit.kind in _RUNNING:
        if not edit.runs:
            raise EditRefused(f"a {edit.kind} requires `runs`", hint="set `runs` to what it executes")
        given = cast("Plain", plain_value(edit.parameters))
        return {edit.kind: edit.runs, **({"with": given} if given else {})}
    if edit.kind not in NODE_KINDS:
        raise EditRefused(f"there is no kind `{edit.kind}`", hint=did_you_mean(edit.kind, (*KINDS, *NODE_KINDS)))
    return {edit.kind: plain_value(NODE_KINDS[edit.kind].new)}


def _check_room(container: NodeRef, nodes: dict[str, Plain]) -> None:
    if container.kind not in NODE_KINDS:
        raise EditRefused(f"`{container.path}` cannot contain nodes", hint="insert the node into a container")
    if container.kind in SLOTS:
        free = _free_slots(container)
        if len(nodes) > len(free):
            left = f"only {', '.join(f'`{key}`' for key in free)} is free" if free else "none of its roles is free"
            raise EditRefused(f"`{container.path}` is full: {left}", hint="remove a child first")
    elif container.kind not in NAMED and container.kind not in GROUPS:
        inside = container.data.get("tree") if container.kind == "tree" else container.body.get("child")
        if inside or len(nodes) > 1:
            hint = (
                "insert them into a container inside"
                if len(nodes) > 1
                else "remove that child first, or insert into a container inside"
            )
            raise EditRefused(f"`{container.path}` can have one child only", hint=hint)


def _free_slots(container: NodeRef, index: int | None = None) -> list[str]:
    """Return the free roles, beginning with those from a position on."""
    order = SLOTS[container.kind]
    start = 0 if index is None else max(0, min(index, len(order) - 1))
    return [key for key in (*order[start:], *order[:start]) if not isinstance(container.body.get(key), dict)]


def _put_in_slots(container: NodeRef, nodes: dict[str, Plain], index: int | None) -> None:
    """Assign the free roles to new children, in order."""
    order = SLOTS[container.kind]
    free = sorted(_free_slots(container, index)[: len(nodes)], key=order.index)
    body = container.data.get(container.kind)
    if not isinstance(body, dict):
        body = container.data[container.kind] = {}
    inside = cast("Plain", body)
    inside.update(zip(free, nodes.values(), strict=True))
    kept = {key: inside[key] for key in order if key in inside}
    rest = {key: each for key, each in inside.items() if key not in kept}
    inside.clear()
    inside.update({**kept, **rest})


def _put_in_tree(
    session: EditSession,
    container: NodeRef,
    nodes: dict[str, Plain],
    names: dict[str, str],
    index: int | None,
    *,
    named: bool,
) -> None:
    inside = [child.data for child in session.outline.children(container)]
    place = len(inside) if index is None else max(0, min(index, len(inside)))
    if container.kind in GROUPS:
        follow = ReferenceUpdate(session)
        body = container.data.get(container.kind)
        if isinstance(body, dict) and not isinstance(cast("Plain", body).get("children"), list):
            cast("Plain", body)["children"] = []
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[place:place] = nodes.values()
        after = [*inside[:place], *nodes.values(), *inside[place:]]
        for name, node in nodes.items():
            if named or (
                tree_names(after)[[id(each) for each in after].index(id(node))] != names[name]
                and name != own_name(node)
            ):
                set_tree_node_name(node, names[name])
        follow.finish()
        return
    if container.kind in SLOTS:
        follow = ReferenceUpdate(session)
        _put_in_slots(container, nodes, index)
        session.stale()
        for child in session.outline.children(session.at(container.path)):
            for name, node in nodes.items():
                if child.data is node and child.name != names[name] and (named or name != own_name(node)):
                    set_tree_node_name(node, names[name])
        follow.finish()
        return
    (name, node), *_ = nodes.items()
    if container.kind == "tree":
        container.data["tree"] = node
    elif isinstance(container.data.get(container.kind), dict):
        container.body["child"] = node
    else:
        container.data[container.kind] = {"child": node}
    if container.kind != "foreach" and (named or name != own_name(node)):
        set_tree_node_name(node, names[name])


def set_tree_node_name(node: Plain, name: str) -> None:
    """Write the name of a tree node, before its other keys."""
    if "name" in node:
        node["name"] = name
    elif own_name(node) != name:
        kept = dict(node)
        node.clear()
        node.update({"name": name, **kept})


def _rewire(
    session: EditSession, container: NodeRef, nodes: dict[str, Plain], names: dict[str, str], known: set[str] | None
) -> None:
    """Update transitions among new children of a machine to their new names; remove targets that are not `known`."""
    machine = session.at(session.outline.path_of(container.data))
    for node in nodes.values():
        for mapping, key, target in list(transition_entries(node)):
            if target in names:
                if mapping[key] != names[target]:
                    mapping[key] = names[target]
            elif known is not None and target not in known and mapping is node.get("transitions"):
                del mapping[key]
                if not mapping:
                    del node["transitions"]
    initial = machine.body.get("initial")
    children = session.outline.children(machine)
    if not isinstance(initial, str) and children:
        write_initial(machine, children[0].name)


def _check_edge(session: EditSession, container: NodeRef, edge: TransitionRef | None) -> None:
    if edge is None:
        return
    source = session.at(edge.source)
    wired = cast("Plain", source.data.get("transitions") or {})
    if container.kind not in MACHINES or edge.outcome not in wired:
        raise EditRefused(
            f"there is no transition of `{source.path}` for `{edge.outcome}`", hint=did_you_mean(edge.outcome, wired)
        )


def _into_edge(session: EditSession, ref: NodeRef, edge: TransitionRef, source: NodeRef) -> None:
    wired = cast("Plain", source.data["transitions"])
    target = str(wired[edge.outcome])
    wired[edge.outcome] = ref.name
    session.mark(source.data)
    ends = session.ends(ref)
    good = ends.success if len(ends.outcomes) > 1 else ends.outcomes
    bad = [outcome for outcome in ends.outcomes if outcome not in good]
    outside = session.outcomes_inside(ref.parent) if bad and ref.parent is not None else ()
    for outcome in ends.outcomes:
        if outcome in good:
            connect(session, ref, outcome, target)
        elif outcome in outside:
            connect(session, ref, outcome, outcome)


def copy_as_yaml(session: EditSession, paths: list[str]) -> str:
    """Return nodes as YAML, each under its name, with their comments."""
    refs = [session.at(path) for path in paths]
    refs = [
        ref for ref in refs if not any(ref is not other and ref.path.startswith(f"{other.path}/") for other in refs)
    ]
    made: dict[str, object] = {}
    for ref in refs:
        number, name = 2, ref.name
        while name in made:
            name, number = f"{ref.name}_{number}", number + 1
        made[name] = ref.data
    rewriter = TextRewriter(session.draft.sources, json=False)
    parts: list[str] = []
    for name, node in made.items():
        written = rewriter.value(node, WritePosition(2, 0, flow=False, beside=None))
        between = "\n  " if written.block else " "
        parts.append(f"{key_text(name, json=False)}:{between}{written.text}\n")
    return indent_text("".join(parts), 0)

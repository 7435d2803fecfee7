"""Edits that put nodes into a container: new ones, copies, and such from a clipboard."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from typing import cast

from engine.document.node import GUARD_TARGETS, KINDS, SLOTS, TREE_KINDS, WRAPPERS
from engine.editing.bench import NAME, Bench, Restructuring, insert_key, states_of
from engine.editing.draft import EditRefused
from engine.editing.edit import AddNode, Duplicate, Edge, Paste, Point, SetPositions
from engine.editing.fields import plain, set_positions
from engine.editing.notation import key_text
from engine.editing.outline import (
    CONTAINERS,
    GROUPS,
    MACHINES,
    NAMED,
    Plain,
    Spot,
    kind_of,
    leads,
    own_name,
    tree_names,
)
from engine.editing.rewriting import Place, Rewriter, shifted
from engine.editing.wiring import begin_with, connect, open_ends
from engine.errors import DocumentError
from engine.nearness import near_names

_RUNNING = ("state", "behavior", "behaviour")
_STEP_PX = 40
_EMPTY: dict[str, object] = {
    "machine": {"states": {}}, "priority": {"states": {}}, "concurrency": {"states": {}, "conditions": []},
    "tree": {"sequence": []}, "foreach": {"times": 1}, "sequence": [], "selector": [], "parallel": [],
    "inverter": {}, "one_shot": {}, "repeat": {"times": 2}, "cooldown": {"after": "1 s"}, "remap": {},
    "condition": {"status": "success"}, "retry": {"times": 1}, "timeout": {"after": "10 s"},
    "guard": {"when": "${true}"}, "if_then_else": {}, "while_do_else": {},
}  # fmt: skip


def add_node(bench: Bench, edit: AddNode) -> None:
    """Put a new node into a container."""
    if edit.yaml:
        paste(bench, Paste(parent=edit.parent, yaml=edit.yaml, position=edit.position, index=edit.index))
        return
    container = bench.at(edit.parent)
    node = _new_node(edit)
    index = edit.index
    after = bench.at(edit.on_edge.source) if edit.on_edge is not None else bench.at(edit.after) if edit.after else None
    if after is not None:
        if after.parent is None or after.parent.data is not container.data:
            raise EditRefused(f"`{after.path}` is not in `{container.path}`", hint="name a child of that container")
        index = (
            [child.name for child in bench.outline.children(container)].index(after.name) + 1
            if index is None
            else index
        )
    _check_edge(bench, container, edit.on_edge)
    tree = container.kind == "tree" or container.is_part
    name = edit.name or (own_name(node) if tree else bench.free_name(container, snake(edit.runs or edit.kind)))
    if edit.name is not None and edit.name in [child.name for child in bench.outline.children(container)]:
        raise EditRefused(f"`{container.path}` has a `{edit.name}` already", hint="choose another name")
    put_in(bench, container, {name: node}, index=index, named=edit.name is not None)
    spot = bench.at(bench.outline.path_of(node))
    if edit.on_edge is not None and after is not None:
        _into_edge(bench, spot, edit.on_edge, bench.at(bench.outline.path_of(after.data)))
    elif after is not None and container.kind in MACHINES:
        good = bench.ends(after).success
        for outcome in open_ends(bench, after):
            if outcome in good:
                connect(bench, after, outcome, spot.name)
    if edit.position is not None:
        set_positions(bench, SetPositions(positions={spot.path: edit.position}))
    bench.mark(node)


def duplicate(bench: Bench, edit: Duplicate) -> None:
    """Put copies of nodes beside them."""
    spots = [bench.at(path) for path in edit.paths]
    for spot in spots:
        if spot.parent is None or (spot.parent.kind not in NAMED and spot.parent.kind not in GROUPS):
            raise EditRefused(f"`{spot.path}` has room for one only", hint="duplicate it inside another container")
    for home in {id(spot.parent): spot.parent for spot in spots if spot.parent is not None}.values():
        mine = [spot for spot in spots if spot.parent is home]
        view = cast("Plain", bench.draft.data.get("view") or {})
        points = {spot.path: view[spot.path] for spot in mine if spot.path in view}
        copies = {spot.name: cast("Plain", bench.draft.copied(spot.data)) for spot in mine}
        last = max([child.name for child in bench.outline.children(home)].index(spot.name) for spot in mine)
        put_in(bench, bench.at(bench.outline.path_of(home.data)), copies, index=last + 1)
        for spot in mine:
            node = copies[spot.name]
            bench.mark(node)
            if spot.path in points:
                x, y = cast("list[float]", points[spot.path])
                positions: dict[str, Point | None] = {bench.outline.path_of(node): (x + _STEP_PX, y + _STEP_PX)}
                set_positions(bench, SetPositions(positions=positions))


def paste(bench: Bench, edit: Paste) -> None:
    """Put nodes from a clipboard into a container."""
    container = bench.at(edit.parent)
    try:
        pasted = bench.draft.adopt(edit.yaml)
    except DocumentError as error:
        raise EditRefused(f"this is not a copy of nodes: {error.message}", hint=error.hint) from error
    for name, node in pasted.items():
        kind = kind_of(cast("Plain", node), in_tree=True) if isinstance(node, dict) else ""
        if not kind or not NAME.fullmatch(name):
            raise EditRefused(f"`{name}` is no node", hint="paste what `copy` gave: names and their nodes")
    if not pasted:
        raise EditRefused("there is nothing to paste", hint="copy some nodes first")
    nodes = {name: cast("Plain", node) for name, node in pasted.items()}
    put_in(bench, container, nodes, index=edit.index, foreign=True)
    positions: dict[str, Point | None] = {}
    for number, node in enumerate(nodes.values()):
        bench.mark(node)
        if edit.position is not None:
            shift = number * _STEP_PX
            positions[bench.outline.path_of(node)] = (edit.position[0] + shift, edit.position[1] + shift)
    if positions:
        set_positions(bench, SetPositions(positions=positions))


def put_in(
    bench: Bench,
    container: Spot,
    nodes: dict[str, Plain],
    *,
    index: int | None = None,
    named: bool = False,
    foreign: bool = False,
) -> None:
    """Put nodes that are in no container into one, under free names, and let them fit there.

    Args:
        bench: The bench.
        container: Where to.
        nodes: The nodes by the names they would like to have; transitions among them follow.
        index: The place of the first; the end without one.
        named: Whether the names were asked for, and so are written also where they would go without saying.
        foreign: Whether the nodes may come from another behavior, so that nothing is known of where they lead to.
    """
    _check_room(container, nodes)
    names: dict[str, str] = {}
    for name in nodes:
        names[name] = bench.free_name(container, name, names.values())
    for node in nodes.values():
        fit(bench, container, node)
    known = {child.name for child in bench.outline.children(container)}
    known |= set(bench.outcomes_inside(container)) if container.kind in MACHINES else set()
    if container.kind in NAMED:
        states = states_of(container)
        for number, (name, node) in enumerate(nodes.items()):
            insert_key(states, names[name], node, None if index is None else index + number)
    else:
        _put_in_tree(bench, container, nodes, names, index, named=named)
    bench.stale()
    if container.kind in MACHINES:
        _rewire(bench, container, nodes, names, known if foreign else None)


def fit(bench: Bench, container: Spot, node: Plain) -> None:
    """Take from a node what it cannot have in a container of this kind."""
    tree = container.kind == "tree" or container.is_part
    kind = kind_of(node, in_tree=True)
    if not tree:
        if kind in TREE_KINDS or kind in WRAPPERS:
            raise EditRefused(f"a `{kind}` stands only inside a tree", hint="put it into a `tree`")
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


def snake(runs: str) -> str:
    """Return a name for what is run: `motion.MoveJoints` is `move_joints`, `sub/pick.yaml` is `pick`."""
    last = PurePosixPath(runs).stem if runs.endswith((".yaml", ".yml", ".json")) else re.split(r"[.:/]", runs)[-1]
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", last).lower()


def _new_node(edit: AddNode) -> Plain:
    if edit.kind in _RUNNING:
        if not edit.runs:
            raise EditRefused(f"a {edit.kind} runs something", hint="say which in `runs`")
        given = cast("Plain", plain(edit.parameters))
        return {edit.kind: edit.runs, **({"with": given} if given else {})}
    if edit.kind not in _EMPTY:
        raise EditRefused(f"there is no kind `{edit.kind}`", hint=near_names(edit.kind, (*KINDS, *_EMPTY)))
    return {edit.kind: plain(_EMPTY[edit.kind])}


def _check_room(container: Spot, nodes: dict[str, Plain]) -> None:
    if container.kind not in CONTAINERS:
        raise EditRefused(f"`{container.path}` holds no other nodes", hint="put it into a container")
    if container.kind in SLOTS:
        free = _free_slots(container)
        if len(nodes) > len(free):
            left = f"only {', '.join(f'`{key}`' for key in free)} is free" if free else "none of its roles is free"
            raise EditRefused(f"`{container.path}` has no room: {left}", hint="remove a child first")
    elif container.kind not in NAMED and container.kind not in GROUPS:
        inside = container.data.get("tree") if container.kind == "tree" else container.body.get("child")
        if inside or len(nodes) > 1:
            hint = (
                "put them into a container inside"
                if len(nodes) > 1
                else "remove that first, or put it into a container inside"
            )
            raise EditRefused(f"`{container.path}` has one child only", hint=hint)


def _free_slots(container: Spot, index: int | None = None) -> list[str]:
    """Return the roles that no child has, those from a place among all on first."""
    order = SLOTS[container.kind]
    start = 0 if index is None else max(0, min(index, len(order) - 1))
    return [key for key in (*order[start:], *order[:start]) if not isinstance(container.body.get(key), dict)]


def _put_in_slots(container: Spot, nodes: dict[str, Plain], index: int | None) -> None:
    """Give new children the free roles, in the order in which they are asked."""
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
    bench: Bench, container: Spot, nodes: dict[str, Plain], names: dict[str, str], index: int | None, *, named: bool
) -> None:
    inside = [child.data for child in bench.outline.children(container)]
    place = len(inside) if index is None else max(0, min(index, len(inside)))
    if container.kind in GROUPS:
        follow = Restructuring(bench)
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
                name_part(node, names[name])
        follow.finish()
        return
    if container.kind in SLOTS:
        follow = Restructuring(bench)
        _put_in_slots(container, nodes, index)
        bench.stale()
        for child in bench.outline.children(bench.at(container.path)):
            for name, node in nodes.items():
                if child.data is node and child.name != names[name] and (named or name != own_name(node)):
                    name_part(node, names[name])
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
        name_part(node, names[name])


def name_part(node: Plain, name: str) -> None:
    """Write the name of a part of a tree, in front of the rest."""
    if "name" in node:
        node["name"] = name
    elif own_name(node) != name:
        kept = dict(node)
        node.clear()
        node.update({"name": name, **kept})


def _rewire(
    bench: Bench, container: Spot, nodes: dict[str, Plain], names: dict[str, str], known: set[str] | None
) -> None:
    """Let new children of a machine lead to one another by their new names, and else only to what is `known`."""
    machine = bench.at(bench.outline.path_of(container.data))
    for node in nodes.values():
        for mapping, key, target in list(leads(node)):
            if target in names:
                if mapping[key] != names[target]:
                    mapping[key] = names[target]
            elif known is not None and target not in known and mapping is node.get("transitions"):
                del mapping[key]
                if not mapping:
                    del node["transitions"]
    initial = machine.body.get("initial")
    children = bench.outline.children(machine)
    if not isinstance(initial, str) and children:
        begin_with(machine, children[0].name)
        bench.stale()


def _check_edge(bench: Bench, container: Spot, edge: Edge | None) -> None:
    if edge is None:
        return
    source = bench.at(edge.source)
    wired = cast("Plain", source.data.get("transitions") or {})
    if container.kind not in MACHINES or edge.outcome not in wired:
        raise EditRefused(
            f"there is no arrow from `{source.path}` by `{edge.outcome}`", hint=near_names(edge.outcome, wired)
        )


def _into_edge(bench: Bench, spot: Spot, edge: Edge, source: Spot) -> None:
    wired = cast("Plain", source.data["transitions"])
    target = str(wired[edge.outcome])
    wired[edge.outcome] = spot.name
    bench.mark(source.data)
    ends = bench.ends(spot)
    outside = bench.outcomes_inside(spot.parent) if spot.parent is not None else ()
    for outcome in ends.outcomes:
        if outcome in ends.success or len(ends.outcomes) == 1:
            connect(bench, spot, outcome, target)
        elif outcome in outside:
            connect(bench, spot, outcome, outcome)


def copied_yaml(bench: Bench, paths: list[str]) -> str:
    """Return nodes as YAML, each under its name, with their comments."""
    spots = [bench.at(path) for path in paths]
    spots = [
        spot
        for spot in spots
        if not any(spot is not other and spot.path.startswith(f"{other.path}/") for other in spots)
    ]
    made: dict[str, object] = {}
    for spot in spots:
        number, name = 2, spot.name
        while name in made:
            name, number = f"{spot.name}_{number}", number + 1
        made[name] = spot.data
    rewriter = Rewriter(bench.draft.sources, json=False)
    parts: list[str] = []
    for name, node in made.items():
        written = rewriter.value(node, Place(2, 0, flow=False, beside=None))
        between = "\n  " if written.block else " "
        parts.append(f"{key_text(name, json=False)}:{between}{written.text}\n")
    return shifted("".join(parts), 0)

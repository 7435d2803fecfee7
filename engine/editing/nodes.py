"""Edits of where nodes are and what they are called: remove, rename, move."""

from __future__ import annotations

from typing import cast

from engine.document.node import SLOTS
from engine.editing.adding import put_in
from engine.editing.bench import Bench, Restructuring, rename_key, seat, states_of
from engine.editing.draft import EditRefused
from engine.editing.edit import MoveNodes, RemoveNodes, RenameNode
from engine.editing.outline import GROUPS, MACHINES, NAMED, Plain, Spot, own_name


def remove_nodes(bench: Bench, edit: RemoveNodes) -> None:
    """Take nodes out."""
    spots = outermost([bench.at(path) for path in edit.paths])
    follow = Restructuring(bench)
    for spot in spots:
        take_out(spot)
    follow.finish()


def rename_node(bench: Bench, edit: RenameNode) -> None:
    """Give a node another name."""
    spot = bench.at(edit.path)
    container = spot.parent
    if container is None:
        raise EditRefused("the outermost node has no name", hint="the document has: change its `name`")
    if container.kind == "foreach":
        raise EditRefused("what a foreach repeats is always called `child`", where=spot.path)
    if edit.name == spot.name:
        return
    taken = {child.name for child in bench.outline.children(container)}
    if edit.name in taken:
        raise EditRefused(f"`{container.path}` has a `{edit.name}` already", hint="choose another name")
    if container.kind in MACHINES and edit.name in bench.outcomes_inside(container):
        hint = "a name is either a child or an outcome; choose another"
        raise EditRefused(f"`{edit.name}` is an outcome of `{container.path}`", hint=hint)
    follow = Restructuring(bench)
    if container.kind in NAMED:
        rename_key(states_of(container), spot.name, edit.name)
    elif own_name({key: value for key, value in spot.data.items() if key != "name"}) == edit.name:
        spot.data.pop("name", None)
    elif "name" in spot.data:
        spot.data["name"] = edit.name
    else:
        kept = dict(spot.data)
        spot.data.clear()
        spot.data.update({"name": edit.name, **kept})
    follow.finish()
    bench.mark(spot.data)


def move_nodes(bench: Bench, edit: MoveNodes) -> None:
    """Put nodes into another container, or elsewhere among their siblings."""
    container = bench.at(edit.parent)
    spots = outermost([bench.at(path) for path in edit.paths])
    for spot in spots:
        if container.path == spot.path or container.path.startswith(f"{spot.path}/"):
            raise EditRefused(f"`{spot.path}` cannot be put into itself")
    if all(spot.parent is container for spot in spots):
        _among_siblings(bench, container, spots, edit.index)
        return
    _check_stays(bench, spots)
    known = set(bench.outcomes_inside(container)) if container.kind in MACHINES else set[str]()
    follow = Restructuring(bench)
    wishes: dict[str, Plain] = {}
    for spot in spots:
        number, name = 2, spot.name
        while name in wishes:
            name, number = f"{spot.name}_{number}", number + 1
        wishes[name] = spot.data
        take_out(spot)
    bench.stale()
    home = bench.at(bench.outline.path_of(container.data))
    leading = {id(spot.data): _leads_of(spot.data) for spot in spots}
    put_in(bench, home, wishes, index=edit.index)
    for spot in spots:
        # What `put_in` has renamed among them is found by identity below.
        _restore(spot.data, leading[id(spot.data)])
        bench.mark(spot.data)
    follow.finish(stray=lambda _, target: target if target in known else None)


def take_out(spot: Spot) -> None:
    """Take a node out of its container; what refers to it is left as it is."""
    container = spot.parent
    if container is None:
        raise EditRefused("the outermost node cannot be taken out", hint="delete the document instead")
    if container.kind in NAMED:
        states_of(container).pop(spot.name, None)
    elif container.kind in GROUPS:
        body = container.data[container.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[:] = [each for each in listed if each is not spot.data]
    elif container.kind == "tree":
        container.data["tree"] = {}
    else:
        container.body.pop(spot.role or "child", None)


def outermost(spots: list[Spot]) -> list[Spot]:
    """Leave out nodes that are inside others of them, and such that are named twice."""
    found: dict[str, Spot] = {spot.path: spot for spot in spots}
    return [
        spot
        for path, spot in found.items()
        if not any(path.startswith(f"{other}/") for other in found if other != path)
    ]


def _among_siblings(bench: Bench, container: Spot, spots: list[Spot], index: int | None) -> None:
    moved = {id(spot.data) for spot in spots}
    rest = [child for child in bench.outline.children(container) if id(child.data) not in moved]
    place = len(rest) if index is None else max(0, min(index, len(rest)))
    order = [*rest[:place], *spots, *rest[place:]]
    follow = Restructuring(bench)
    if container.kind in NAMED:
        states = states_of(container)
        left = {key: each for key, each in states.items() if not any(child.name == key for child in order)}
        states.clear()
        states.update({**{child.name: child.data for child in order}, **left})
    elif container.kind in GROUPS:
        body = container.data[container.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[:] = [child.data for child in order]
    elif container.kind in SLOTS:
        seat(container, [child.data for child in order])
    follow.finish()
    for spot in spots:
        bench.mark(spot.data)


def _check_stays(bench: Bench, spots: list[Spot]) -> None:
    for spot in spots:
        if spot.parent is None:
            raise EditRefused("the outermost node cannot be moved")
    del bench


def _leads_of(node: Plain) -> dict[str, object]:
    wired = node.get("transitions")
    return dict(cast("Plain", wired)) if isinstance(wired, dict) else {}


def _restore(node: Plain, transitions: dict[str, object]) -> None:
    wired = node.get("transitions")
    if isinstance(wired, dict):
        cast("Plain", wired).update({key: to for key, to in transitions.items() if key in wired})

"""Edits that take a container away and leave what was inside in its place."""

from __future__ import annotations

from typing import cast

from engine.document.node import SLOTS
from engine.editing.bench import Bench, Restructuring, states_of
from engine.editing.draft import EditRefused
from engine.editing.edit import Point, SetPositions, Ungroup
from engine.editing.fields import set_positions
from engine.editing.outline import GROUPS, MACHINES, NAMED, Plain, Spot

_LOST = ("guard", "post", "timeout", "retry", "on_error", "autonomy", "resume")


def ungroup(bench: Bench, edit: Ungroup) -> None:
    """Put the children of a container in its place."""
    spot = bench.at(edit.path)
    home = spot.parent
    if home is None:
        raise EditRefused("the outermost node has nothing around it", hint="ungroup what is inside")
    children = bench.outline.children(spot)
    if not children:
        raise EditRefused(f"`{spot.path}` is empty", hint="remove it")
    for key in _LOST:
        if key in spot.data and key != spot.kind:
            raise EditRefused(f"the `{key}` of `{spot.path}` would be lost", hint="take it away first")
    if spot.body.get("userdata"):
        raise EditRefused(f"the userdata of `{spot.path}` would be lost", hint="declare it further outside first")
    if home.kind in MACHINES and spot.kind == "machine":
        _machine_in_machine(bench, home, spot, children)
    elif home.kind in MACHINES and spot.kind == "tree":
        _tree_in_machine(bench, home, spot)
    elif home.is_part or home.kind == "tree":
        _in_tree(bench, home, spot, children)
    elif spot.kind in MACHINES and len(children) == 1:
        _only_one(bench, home, spot, children[0])
    else:
        hint = "ungroup machines in machines, plain sequences, and parts of trees"
        raise EditRefused(f"a {spot.kind} in a {home.kind} cannot be taken away and mean the same", hint=hint)


def _machine_in_machine(bench: Bench, home: Spot, spot: Spot, children: tuple[Spot, ...]) -> None:
    leaving = cast("Plain", spot.data.get("transitions") or {})
    initial = spot.body.get("initial")
    entry = next((child for child in children if child.name == initial), children[0])
    corner = _point(bench, spot)
    points = {id(child.data): _point(bench, child) for child in children}
    follow = Restructuring(bench)
    names = _put_in_place(bench, home, spot, children)
    follow.finish(
        instead={id(spot.data): names[id(entry.data)]},
        stray=lambda _, target: cast("str | None", leaving.get(target)),
    )
    _place(bench, children, points, corner)
    for child in children:
        bench.mark(child.data)


def _put_in_place(bench: Bench, home: Spot, spot: Spot, children: tuple[Spot, ...]) -> dict[int, str]:
    """Put children where their container was; returns their names by the id of their data."""
    taken = {child.name for child in bench.outline.children(home)} - {spot.name}
    taken |= set(bench.outcomes_inside(home))
    names: dict[int, str] = {}
    for child in children:
        number, name = 2, child.name
        while name in taken:
            name, number = f"{child.name}_{number}", number + 1
        taken.add(name)
        names[id(child.data)] = name
    states = states_of(home)
    kept: Plain = {}
    for key, each in states.items():
        kept |= {names[id(child.data)]: child.data for child in children} if key == spot.name else {key: each}
    for child in children:
        states_of(spot).pop(child.name, None)
    states.clear()
    states.update(kept)
    return names


def _tree_in_machine(bench: Bench, home: Spot, spot: Spot) -> None:
    """Turn a plain sequence or selector into states that follow one another."""
    (part,) = bench.outline.children(spot)
    steps = bench.outline.children(part)
    if part.kind not in ("sequence", "selector") or not steps or any(step.is_part for step in steps):
        hint = "only a sequence or selector of states and containers can be"
        raise EditRefused(f"`{spot.path}` cannot become states that follow one another", hint=hint)
    if isinstance(part.data.get(part.kind), dict) and part.body.get("memory") is False:
        raise EditRefused(
            f"`{part.path}` has no memory", hint="only one with memory runs its children one after the other"
        )
    if any("post" in step.data for step in steps):
        raise EditRefused(f"a step of `{spot.path}` has a `post`, which would be lost", hint="take it away first")
    if any(_guard(step).get("to") == "skipped" for step in steps):
        raise EditRefused(
            f"a step of `{spot.path}` may be skipped, which a machine does not know", hint="guard it else"
        )
    leaving = cast("Plain", spot.data.get("transitions") or {})
    ends = {id(step.data): bench.ends(step) for step in steps}
    follow = Restructuring(bench)
    taken = {child.name for child in bench.outline.children(home)} - {spot.name} | set(bench.outcomes_inside(home))
    names: list[str] = []
    for step in steps:
        number, name = 2, step.name
        while name in taken:
            name, number = f"{step.name}_{number}", number + 1
        taken.add(name)
        names.append(name)
    onward = "success" if part.kind == "sequence" else "failure"
    for number, step in enumerate(steps):
        good = tuple(cast("list[str]", step.data.pop("success", []))) or ends[id(step.data)].success
        step.data.pop("name", None)
        wired: Plain = {}
        for outcome in ends[id(step.data)].outcomes:
            status = "success" if outcome in good else "failure"
            onto = names[number + 1] if status == onward and number + 1 < len(steps) else leaving.get(status)
            if onto is not None:
                wired[outcome] = onto
        _divert(step.data, leaving)
        if wired:
            step.data["transitions"] = wired
    states = states_of(home)
    kept: Plain = {}
    for key, each in states.items():
        kept |= dict(zip(names, [s.data for s in steps], strict=True)) if key == spot.name else {key: each}
    states.clear()
    states.update(kept)
    follow.finish(instead={id(spot.data): names[0]}, stray=lambda _, target: target)
    for step in steps:
        bench.mark(step.data)


def _guard(spot: Spot) -> Plain:
    guard = spot.data.get("guard")
    return cast("Plain", guard) if isinstance(guard, dict) else {}


def _divert(node: Plain, leaving: Plain) -> None:
    """Let timeout, guard and on_error of what was a leaf of a tree lead where its status led."""
    for key in ("timeout", "guard"):
        measure = node.get(key)
        if isinstance(measure, dict) and isinstance(cast("Plain", measure).get("to"), str):
            found = cast("Plain", measure)
            found["to"] = leaving.get(str(found["to"]), found["to"])
    if isinstance(node.get("on_error"), str):
        node["on_error"] = leaving.get(str(node["on_error"]), node["on_error"])


def _in_tree(bench: Bench, home: Spot, spot: Spot, children: tuple[Spot, ...]) -> None:
    if not spot.is_part:
        raise EditRefused(f"a {spot.kind} cannot become parts of a tree", hint="ungroup composites and decorators")
    if len(children) > 1 and (home.kind != spot.kind or spot.kind == "parallel" or spot.kind in SLOTS):
        raise EditRefused(
            f"a {spot.kind} in a {home.kind} means something else without it", hint="change its kind first"
        )
    first = next(iter(children))
    follow = Restructuring(bench)
    if home.kind in GROUPS:
        body = home.data[home.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        place = next(number for number, each in enumerate(listed) if each is spot.data)
        listed[place : place + 1] = [child.data for child in children]
    elif home.kind == "tree":
        home.data["tree"] = first.data
    else:
        home.body[spot.role or "child"] = first.data
    follow.finish()
    for child in children:
        bench.mark(child.data)


def _only_one(bench: Bench, home: Spot, spot: Spot, child: Spot) -> None:
    wired = cast("Plain", child.data.get("transitions") or {})
    if any(outcome != to for outcome, to in wired.items()):
        hint = "lead each outcome to one of the same name first"
        raise EditRefused(f"the outcomes of `{spot.path}` have other names than those of `{child.name}`", hint=hint)
    follow = Restructuring(bench)
    if home.kind in NAMED:
        states = states_of(home)
        kept = {key: child.data if each is spot.data else each for key, each in states.items()}
        states.clear()
        states.update(kept)
        name = spot.name
    else:
        home.body["child"] = child.data
        name = "child"
    follow.finish(instead={id(spot.data): name}, stray=lambda _, target: target)
    child.data.pop("transitions", None)
    bench.mark(child.data)


def _point(bench: Bench, spot: Spot) -> tuple[float, float] | None:
    view = bench.draft.data.get("view")
    point = cast("Plain", view).get(spot.path) if isinstance(view, dict) else None
    if not isinstance(point, list) or len(cast("list[float]", point)) != 2:
        return None
    x, y = cast("list[float]", point)
    return (x, y)


def _place(
    bench: Bench,
    children: tuple[Spot, ...],
    points: dict[int, tuple[float, float] | None],
    corner: tuple[float, float] | None,
) -> None:
    positions: dict[str, Point | None] = {}
    for child in children:
        point = points[id(child.data)]
        if point is not None and corner is not None:
            positions[bench.outline.path_of(child.data)] = (point[0] + corner[0], point[1] + corner[1])
    if positions:
        set_positions(bench, SetPositions(positions=positions))

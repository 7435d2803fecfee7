"""Edits that put a container around siblings; what leads out of them becomes the outcomes of the container."""

from __future__ import annotations

from itertools import product
from typing import cast

from engine.document.node import SLOTS
from engine.editing.adding import name_part
from engine.editing.bench import Bench, Restructuring, insert_key, states_of
from engine.editing.draft import EditRefused
from engine.editing.edit import Group, Point, SetPositions
from engine.editing.fields import set_positions
from engine.editing.nodes import outermost, take_out
from engine.editing.outline import GROUPS, MACHINES, Plain, Spot, leads

_MARGIN_PX = (40, 60)
"""Between the corner of a container and the first of its children."""
_MOST_RULES = 16


def group(bench: Bench, edit: Group) -> None:
    """Put siblings into a new container."""
    spots = outermost([bench.at(path) for path in edit.paths])
    if not spots:
        raise EditRefused("nothing is chosen", hint="choose the nodes to be grouped")
    home = spots[0].parent
    if home is None:
        raise EditRefused("the outermost node cannot be grouped", hint="group what is inside")
    if any(spot.parent is not home for spot in spots):
        raise EditRefused("only nodes of one container can be grouped", hint="choose siblings")
    order = [child.name for child in bench.outline.children(home)]
    spots.sort(key=lambda spot: order.index(spot.name))
    if edit.name is not None and edit.name in order and edit.name not in [spot.name for spot in spots]:
        raise EditRefused(f"`{home.path}` has a `{edit.name}` already", hint="choose another name")
    if home.kind in MACHINES:
        _in_machine(bench, edit, home, spots)
    elif home.kind == "tree" or home.is_part:
        _in_tree(bench, edit, home, spots)
    else:
        _around_one(bench, edit, home, spots)


def _in_machine(bench: Bench, edit: Group, home: Spot, spots: list[Spot]) -> None:
    # Branches are entered all at once, wherever one leads to.
    entry = spots[0].name if edit.kind in ("concurrency", "parallel") else _entry(bench, home, spots)
    crossing = _crossing(spots)
    if edit.kind in MACHINES:
        inside: Plain = {"initial": entry, "states": {spot.name: spot.data for spot in spots}}
        made: Plain = {edit.kind: inside}
        wired = {target: target for target in crossing}
    elif edit.kind == "concurrency":
        conditions = _conditions(bench, spots)
        inside = {"states": {spot.name: spot.data for spot in spots}, "conditions": conditions}
        made = {"concurrency": inside}
        wired = {target: target for target in dict.fromkeys(next(iter(rule)) for rule in conditions)}
    else:
        spots, wired = _chain(bench, edit.kind, spots, entry)
        made = {"tree": {edit.kind: [spot.data for spot in spots]}}
    if wired:
        made["transitions"] = wired
    _replace_in_named(bench, edit, home, spots, made)


def _replace_in_named(bench: Bench, edit: Group, home: Spot, spots: list[Spot], made: Plain) -> None:
    name = edit.name or bench.free_name(home, "group")
    points = _points(bench, spots)
    place = min(list(home.states).index(spot.name) for spot in spots)
    follow = Restructuring(bench)
    for spot in spots:
        take_out(spot)
        if edit.kind not in MACHINES:
            spot.data.pop("transitions", None)
        if edit.kind in GROUPS:
            for measure in ("timeout", "guard"):
                if isinstance(spot.data.get(measure), dict):
                    cast("Plain", spot.data[measure])["to"] = "failure"
            if "on_error" in spot.data:
                spot.data["on_error"] = "failure"
            name_part(spot.data, spot.name)
    insert_key(states_of(home), name, made, place)
    follow.finish(instead={id(spot.data): name for spot in spots}, stray=lambda _, target: target)
    if points:
        corner = [min(point[axis] for point in points.values()) - _MARGIN_PX[axis] for axis in (0, 1)]
        positions: dict[str, Point | None] = {bench.outline.path_of(made): (corner[0], corner[1])}
        if edit.kind not in GROUPS:
            by_id = {id(spot.data): points[spot.path] for spot in spots if spot.path in points}
            for child in bench.outline.children(bench.at(bench.outline.path_of(made))):
                if id(child.data) in by_id:
                    x, y = by_id[id(child.data)]
                    positions[child.path] = (x - corner[0], y - corner[1])
        set_positions(bench, SetPositions(positions=positions))
    bench.mark(made)


def _entry(bench: Bench, home: Spot, spots: list[Spot]) -> str:
    """Return the one member that is entered from outside."""
    names = {spot.name for spot in spots}
    outside = [child for child in bench.outline.children(home) if child.name not in names]
    entered = dict.fromkeys(to for child in outside for _, _, to in leads(child.data) if to in names)
    initial = home.body.get("initial")
    if isinstance(initial, str) and initial in names:
        entered = dict.fromkeys((initial, *entered))
    if len(entered) > 1:
        listed = " and ".join(f"`{name}`" for name in entered)
        raise EditRefused(f"{listed} are entered from outside, but a container begins in one place", where=home.path)
    return next(iter(entered), spots[0].name)


def _crossing(spots: list[Spot]) -> list[str]:
    """Return where members lead to outside of them, each once."""
    names = {spot.name for spot in spots}
    return list(dict.fromkeys(to for spot in spots for _, _, to in leads(spot.data) if to not in names))


def _conditions(bench: Bench, spots: list[Spot]) -> list[Plain]:
    """Return the rules of a concurrency container: all good ends together lead on, each other one leads out."""
    names = {spot.name for spot in spots}
    good = {spot.name: bench.ends(spot).success for spot in spots}
    onward = dict.fromkeys(
        to for spot in spots for how, to in _transitions(spot).items() if how in good[spot.name] and to not in names
    )
    found: list[Plain] = []
    if len(onward) == 1 and all(good.values()):
        combinations = list(product(*good.values()))
        if len(combinations) > _MOST_RULES:
            raise EditRefused("these end well in too many ways for conditions", hint="group fewer of them")
        for each in combinations:
            found.append({next(iter(onward)): dict(zip(good, each, strict=True))})
    for spot in spots:
        for mapping, key, to in leads(spot.data):
            outcome = key if mapping is spot.data.get("transitions") else to
            if to not in names and not (len(onward) == 1 and outcome in good[spot.name]):
                found.append({to: {spot.name: outcome}})
    return found


def _chain(bench: Bench, kind: str, spots: list[Spot], entry: str) -> tuple[list[Spot], dict[str, str]]:
    """Return members in the order in which a tree would run them, and where success and failure lead."""
    by_name = {spot.name: spot for spot in spots}
    onward = "success" if kind == "sequence" else "failure"
    order: list[Spot] = []
    due: str | None = entry
    ways: dict[str, dict[str, None]] = {"success": {}, "failure": {}}
    while due is not None and kind != "parallel":
        spot = by_name[due]
        if spot in order:
            raise EditRefused(f"`{due}` is run again, but a {kind} does not go back", hint="group them as a machine")
        order.append(spot)
        split = _split(bench, spot)
        inside = [to for to in split[onward] if to in by_name]
        other = "failure" if onward == "success" else "success"
        back = [to for to in split[other] if to in by_name]
        if len(set(inside)) > 1 or back or (inside and len(set(split[onward])) > 1):
            raise EditRefused(f"`{due}` goes on in more than one way", hint=f"only what is a plain {kind} can be one")
        due = inside[0] if inside else None
        for status in ways:
            ways[status] |= {to: None for to in split[status] if to not in by_name}
    for spot in spots if kind == "parallel" else ():
        order.append(spot)
        split = _split(bench, spot)
        if any(to in by_name for to in (*split["success"], *split["failure"])):
            raise EditRefused(f"`{spot.name}` leads to another of them", hint="what runs side by side does not")
        for status in ways:
            ways[status] |= dict.fromkeys(split[status])
    if len(order) < len(spots):
        left = next(spot.name for spot in spots if spot not in order)
        raise EditRefused(
            f"`{left}` is not on the way from `{entry}`", hint=f"choose what follows one another as a {kind}"
        )
    for status, targets in ways.items():
        if len(targets) > 1:
            listed = ", ".join(f"`{to}`" for to in targets)
            raise EditRefused(
                f"their {status} leads to {listed}, but that of a {kind} leads to one", hint="group them as a machine"
            )
    return order, {status: next(iter(targets)) for status, targets in ways.items() if targets}


def _split(bench: Bench, spot: Spot) -> dict[str, list[str]]:
    """Return where the good ends of a node lead, and the others."""
    good = bench.ends(spot).success
    wired = _transitions(spot)
    others = [to for mapping, _, to in leads(spot.data) if mapping is not spot.data.get("transitions")]
    return {
        "success": [to for outcome, to in wired.items() if outcome in good],
        "failure": [*(to for outcome, to in wired.items() if outcome not in good), *others],
    }


def _in_tree(bench: Bench, edit: Group, home: Spot, spots: list[Spot]) -> None:
    if edit.kind not in GROUPS:
        raise EditRefused(
            f"inside a tree nodes are not grouped as a {edit.kind}", hint="use sequence, selector or parallel"
        )
    made: Plain = {edit.kind: [spot.data for spot in spots]}
    if edit.name is not None:
        made = {"name": edit.name, **made}
    children = list(bench.outline.children(home))
    places = [next(i for i, child in enumerate(children) if child.data is spot.data) for spot in spots]
    if places != list(range(places[0], places[0] + len(places))):
        raise EditRefused("these do not follow one another", hint="choose neighbours")
    if home.kind in SLOTS and len(spots) > 1:
        raise EditRefused(f"the children of a {home.kind} have roles", hint="group one of them")
    follow = Restructuring(bench)
    if home.kind in GROUPS:
        body = home.data[home.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[places[0] : places[0] + len(spots)] = [made]
    elif home.kind == "tree":
        home.data["tree"] = made
    else:
        home.body[spots[0].role or "child"] = made
    follow.finish()
    bench.mark(made)


def _around_one(bench: Bench, edit: Group, home: Spot, spots: list[Spot]) -> None:
    """Put a container around a branch of a concurrency container, or what a foreach repeats."""
    if len(spots) > 1:
        hint = "conditions speak of each of them; put a container around one"
        raise EditRefused(f"branches of a {home.kind} cannot be grouped", hint=hint)
    if edit.kind not in MACHINES:
        raise EditRefused(f"a branch of a {home.kind} cannot be grouped as a {edit.kind}", hint="use a machine")
    (spot,) = spots
    outcomes = bench.ends(spot).outcomes
    named = spot.name if home.kind == "concurrency" else "step"
    made: Plain = {edit.kind: {"initial": named, "states": {named: spot.data}}}
    name = edit.name or spot.name
    follow = Restructuring(bench)
    if home.kind == "concurrency":
        states = states_of(home)
        kept = {name if key == spot.name else key: made if key == spot.name else each for key, each in states.items()}
        states.clear()
        states.update(kept)
    else:
        home.body["child"] = made
    follow.finish(instead={id(spot.data): name}, stray=lambda _, target: target)
    spot.data["transitions"] = {outcome: outcome for outcome in outcomes}
    bench.mark(made)


def _transitions(spot: Spot) -> dict[str, str]:
    wired = spot.data.get("transitions")
    found = cast("Plain", wired) if isinstance(wired, dict) else {}
    return {outcome: to for outcome, to in found.items() if isinstance(to, str)}


def _points(bench: Bench, spots: list[Spot]) -> dict[str, tuple[float, float]]:
    view = cast("Plain", bench.draft.data.get("view") or {})
    found: dict[str, tuple[float, float]] = {}
    for spot in spots:
        point = view.get(spot.path)
        if isinstance(point, list) and len(cast("list[float]", point)) == 2:
            x, y = cast("list[float]", point)
            found[spot.path] = (x, y)
    return found

"""Edits that group siblings in a container; transitions that leave them become outcomes of the container."""

from __future__ import annotations

from itertools import product
from typing import cast

from engine.document.nodes.node_kind import GROUPS, MACHINES, SLOTS
from engine.editing.edits.edit import CanvasPoint, GroupNodes, SetPositions
from engine.editing.edits.edit_session import EditSession, ReferenceUpdate, insert_key, named_children
from engine.editing.edits.field_edits import set_positions
from engine.editing.edits.node_edits import detach_node, outermost
from engine.editing.edits.node_insertion import set_tree_node_name
from engine.editing.text.draft import EditRefused
from engine.editing.text.outline import NodeRef, Plain, transition_entries

_MARGIN_PX = (40, 60)
"""Offset between the corner of a container and its first child."""
_MOST_RULES = 16


def group(session: EditSession, edit: GroupNodes) -> None:
    """Group siblings in a new container."""
    refs = outermost([session.at(path) for path in edit.paths])
    if not refs:
        raise EditRefused("no nodes are selected", hint="select the nodes to group")
    home = refs[0].parent
    if home is None:
        raise EditRefused("the root node cannot be grouped", hint="group nodes inside it")
    if any(ref.parent is not home for ref in refs):
        raise EditRefused("only nodes of one container can be grouped", hint="select siblings")
    order = [child.name for child in session.outline.children(home)]
    refs.sort(key=lambda ref: order.index(ref.name))
    if edit.name is not None and edit.name in order and edit.name not in [ref.name for ref in refs]:
        raise EditRefused(f"`{home.path}` has a `{edit.name}` already", hint="choose another name")
    if home.kind in MACHINES:
        _in_machine(session, edit, home, refs)
    elif home.kind == "tree" or home.is_part:
        _in_tree(session, edit, home, refs)
    else:
        _around_one(session, edit, home, refs)


def _in_machine(session: EditSession, edit: GroupNodes, home: NodeRef, refs: list[NodeRef]) -> None:
    # All branches are entered together, whatever their targets are.
    entry = refs[0].name if edit.kind in ("concurrency", "parallel") else _entry(session, home, refs)
    crossing = _crossing(refs)
    if edit.kind in MACHINES:
        inside: Plain = {"initial": entry, "states": {ref.name: ref.data for ref in refs}}
        made: Plain = {edit.kind: inside}
        wired = {target: target for target in crossing}
    elif edit.kind == "concurrency":
        conditions = _conditions(session, refs)
        inside = {"states": {ref.name: ref.data for ref in refs}, "conditions": conditions}
        made = {"concurrency": inside}
        wired = {target: target for target in dict.fromkeys(next(iter(rule)) for rule in conditions)}
    else:
        refs, wired = _chain(session, edit.kind, refs, entry)
        made = {"tree": {edit.kind: [ref.data for ref in refs]}}
    if wired:
        made["transitions"] = wired
    _replace_in_named(session, edit, home, refs, made)


def _replace_in_named(session: EditSession, edit: GroupNodes, home: NodeRef, refs: list[NodeRef], made: Plain) -> None:
    name = edit.name or session.free_name(home, "group")
    points = _points(session, refs)
    place = min(list(home.states).index(ref.name) for ref in refs)
    follow = ReferenceUpdate(session)
    for ref in refs:
        detach_node(ref)
        if edit.kind not in MACHINES:
            ref.data.pop("transitions", None)
        if edit.kind in GROUPS:
            for measure in ("timeout", "guard"):
                if isinstance(ref.data.get(measure), dict):
                    cast("Plain", ref.data[measure])["to"] = "failure"
            if "on_error" in ref.data:
                ref.data["on_error"] = "failure"
            if ref.data.get("disabled"):
                ref.data["disabled"] = True
            set_tree_node_name(ref.data, ref.name)
    insert_key(named_children(home), name, made, place)
    follow.finish(instead={id(ref.data): name for ref in refs}, dangling=lambda _, target: target)
    if points:
        corner = [min(point[axis] for point in points.values()) - _MARGIN_PX[axis] for axis in (0, 1)]
        positions: dict[str, CanvasPoint | None] = {session.outline.path_of(made): (corner[0], corner[1])}
        if edit.kind not in GROUPS:
            by_id = {id(ref.data): points[ref.path] for ref in refs if ref.path in points}
            for child in session.outline.children(session.at(session.outline.path_of(made))):
                if id(child.data) in by_id:
                    x, y = by_id[id(child.data)]
                    positions[child.path] = (x - corner[0], y - corner[1])
        set_positions(session, SetPositions(positions=positions))
    session.mark(made)


def _entry(session: EditSession, home: NodeRef, refs: list[NodeRef]) -> str:
    """Return the only member that is entered from outside."""
    names = {ref.name for ref in refs}
    outside = [child for child in session.outline.children(home) if child.name not in names]
    entered = dict.fromkeys(to for child in outside for _, _, to in transition_entries(child.data) if to in names)
    initial = home.body.get("initial")
    if isinstance(initial, str) and initial in names:
        entered = dict.fromkeys((initial, *entered))
    if len(entered) > 1:
        listed = " and ".join(f"`{name}`" for name in entered)
        raise EditRefused(
            f"{listed} are all entered from outside, but a container has one initial node", where=home.path
        )
    return next(iter(entered), refs[0].name)


def _crossing(refs: list[NodeRef]) -> list[str]:
    """Return the targets of members outside the group, each once."""
    names = {ref.name for ref in refs}
    return list(dict.fromkeys(to for ref in refs for _, _, to in transition_entries(ref.data) if to not in names))


def _conditions(session: EditSession, refs: list[NodeRef]) -> list[Plain]:
    """Return the rules of a concurrency container: all success outcomes together lead on, each other one leads out."""
    names = {ref.name for ref in refs}
    good = {ref.name: session.ends(ref).success for ref in refs}
    onward = dict.fromkeys(
        to for ref in refs for how, to in _transitions(ref).items() if how in good[ref.name] and to not in names
    )
    found: list[Plain] = []
    if len(onward) == 1 and all(good.values()):
        combinations = list(product(*good.values()))
        if len(combinations) > _MOST_RULES:
            raise EditRefused(
                "these nodes have too many combinations of success outcomes for conditions", hint="group fewer nodes"
            )
        found.extend({next(iter(onward)): dict(zip(good, each, strict=True))} for each in combinations)
    for ref in refs:
        for mapping, key, to in transition_entries(ref.data):
            outcome = key if mapping is ref.data.get("transitions") else to
            if to not in names and not (len(onward) == 1 and outcome in good[ref.name]):
                found.append({to: {ref.name: outcome}})
    return found


def _chain(session: EditSession, kind: str, refs: list[NodeRef], entry: str) -> tuple[list[NodeRef], dict[str, str]]:
    """Return members in the order in which a tree executes them, and the targets of success and failure."""
    by_name = {ref.name: ref for ref in refs}
    onward = "success" if kind == "sequence" else "failure"
    order: list[NodeRef] = []
    due: str | None = entry
    targets_of: dict[str, dict[str, None]] = {"success": {}, "failure": {}}
    while due is not None and kind != "parallel":
        ref = by_name[due]
        if ref in order:
            raise EditRefused(
                f"`{due}` is entered again, but a {kind} has no loops", hint="group the nodes as a machine"
            )
        order.append(ref)
        split = _split(session, ref)
        inside = [to for to in split[onward] if to in by_name]
        other = "failure" if onward == "success" else "success"
        back = [to for to in split[other] if to in by_name]
        if len(set(inside)) > 1 or back or (inside and len(set(split[onward])) > 1):
            raise EditRefused(f"`{due}` has more than one next node", hint=f"only a plain chain can become a {kind}")
        due = inside[0] if inside else None
        for status in targets_of:
            targets_of[status] |= {to: None for to in split[status] if to not in by_name}
    for ref in refs if kind == "parallel" else ():
        order.append(ref)
        split = _split(session, ref)
        if any(to in by_name for to in (*split["success"], *split["failure"])):
            raise EditRefused(
                f"`{ref.name}` leads to another selected node", hint="concurrent nodes cannot lead to one another"
            )
        for status in targets_of:
            targets_of[status] |= dict.fromkeys(split[status])
    if len(order) < len(refs):
        left = next(ref.name for ref in refs if ref not in order)
        raise EditRefused(
            f"`{left}` is not reachable from `{entry}`", hint=f"select nodes that follow one another as a {kind}"
        )
    for status, targets in targets_of.items():
        if len(targets) > 1:
            listed = ", ".join(f"`{to}`" for to in targets)
            raise EditRefused(
                f"their {status} leads to {listed}, but a {kind} has one target per status",
                hint="group them as a machine",
            )
    return order, {status: next(iter(targets)) for status, targets in targets_of.items() if targets}


def _split(session: EditSession, ref: NodeRef) -> dict[str, list[str]]:
    """Return the targets of the success outcomes of a node, and those of the others."""
    good = session.ends(ref).success
    wired = _transitions(ref)
    others = [to for mapping, _, to in transition_entries(ref.data) if mapping is not ref.data.get("transitions")]
    return {
        "success": [to for outcome, to in wired.items() if outcome in good],
        "failure": [*(to for outcome, to in wired.items() if outcome not in good), *others],
    }


def _in_tree(session: EditSession, edit: GroupNodes, home: NodeRef, refs: list[NodeRef]) -> None:
    if edit.kind not in GROUPS:
        raise EditRefused(
            f"nodes inside a tree cannot be grouped as a {edit.kind}", hint="use sequence, selector or parallel"
        )
    made: Plain = {edit.kind: [ref.data for ref in refs]}
    if edit.name is not None:
        made = {"name": edit.name, **made}
    children = list(session.outline.children(home))
    places = [next(i for i, child in enumerate(children) if child.data is ref.data) for ref in refs]
    if places != list(range(places[0], places[0] + len(places))):
        raise EditRefused("these nodes are not adjacent", hint="select adjacent nodes")
    if home.kind in SLOTS and len(refs) > 1:
        raise EditRefused(f"the children of a {home.kind} have roles", hint="group one of them")
    follow = ReferenceUpdate(session)
    if home.kind in GROUPS:
        body = home.data[home.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        listed[places[0] : places[0] + len(refs)] = [made]
    elif home.kind == "tree":
        home.data["tree"] = made
    else:
        home.body[refs[0].role or "child"] = made
    follow.finish()
    session.mark(made)


def _around_one(session: EditSession, edit: GroupNodes, home: NodeRef, refs: list[NodeRef]) -> None:
    """Group a branch of a concurrency container, or the child of a foreach."""
    if len(refs) > 1:
        hint = "conditions name each branch; group a single branch"
        raise EditRefused(f"branches of a {home.kind} cannot be grouped", hint=hint)
    if edit.kind not in MACHINES:
        raise EditRefused(f"a branch of a {home.kind} cannot be grouped as a {edit.kind}", hint="use a machine")
    (ref,) = refs
    outcomes = session.ends(ref).outcomes
    named = ref.name if home.kind == "concurrency" else "step"
    made: Plain = {edit.kind: {"initial": named, "states": {named: ref.data}}}
    name = edit.name or ref.name
    follow = ReferenceUpdate(session)
    if home.kind == "concurrency":
        states = named_children(home)
        kept = {name if key == ref.name else key: made if key == ref.name else each for key, each in states.items()}
        states.clear()
        states.update(kept)
    else:
        home.body["child"] = made
    follow.finish(instead={id(ref.data): name}, dangling=lambda _, target: target)
    ref.data["transitions"] = {outcome: outcome for outcome in outcomes}
    session.mark(made)


def _transitions(ref: NodeRef) -> dict[str, str]:
    wired = ref.data.get("transitions")
    found = cast("Plain", wired) if isinstance(wired, dict) else {}
    return {outcome: to for outcome, to in found.items() if isinstance(to, str)}


def _points(session: EditSession, refs: list[NodeRef]) -> dict[str, tuple[float, float]]:
    view = cast("Plain", session.draft.data.get("view") or {})
    found: dict[str, tuple[float, float]] = {}
    for ref in refs:
        point = view.get(ref.path)
        if isinstance(point, list) and len(cast("list[float]", point)) == 2:
            x, y = cast("list[float]", point)
            found[ref.path] = (x, y)
    return found

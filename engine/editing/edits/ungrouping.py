"""Edits that replace a container with its children."""

from __future__ import annotations

from typing import cast

from engine.document.nodes.node_kind import GROUPS, MACHINES, NAMED, SLOTS
from engine.editing.edits.edit import CanvasPoint, SetPositions, UngroupNode
from engine.editing.edits.edit_session import EditSession, ReferenceUpdate, named_children
from engine.editing.edits.field_edits import set_positions
from engine.editing.edits.note_edits import all_notes, move_notes
from engine.editing.text.draft import EditRefused
from engine.editing.text.outline import NodeRef, Plain

_LOST = ("guard", "post", "timeout", "retry", "on_error", "autonomy", "resume", "disabled")


def ungroup(session: EditSession, edit: UngroupNode) -> None:
    """Replace a container with its children."""
    ref = session.at(edit.path)
    home = ref.parent
    if home is None:
        raise EditRefused("the root node cannot be ungrouped", hint="ungroup containers inside it")
    children = session.outline.children(ref)
    if not children:
        raise EditRefused(f"`{ref.path}` is empty", hint="remove it")
    for key in _LOST:
        if key in ref.data and key != ref.kind:
            raise EditRefused(f"the `{key}` of `{ref.path}` would be lost", hint="remove it first")
    if ref.body.get("userdata"):
        raise EditRefused(f"the userdata of `{ref.path}` would be lost", hint="declare it further outside first")
    left = cast("Plain", all_notes(session).get(ref.path) or {})
    corner = _point(session, ref) or (0.0, 0.0)
    if home.kind in MACHINES and ref.kind == "machine":
        _machine_in_machine(session, home, ref, children)
    elif home.kind in MACHINES and ref.kind == "tree":
        _tree_in_machine(session, home, ref)
    elif home.is_part or home.kind == "tree":
        _in_tree(session, home, ref, children)
    elif ref.kind in MACHINES and len(children) == 1:
        _only_one(session, home, ref, children[0])
    else:
        hint = "ungroup machines in machines, plain sequences, and parts of trees"
        raise EditRefused(f"ungrouping a {ref.kind} in a {home.kind} would change the behavior", hint=hint)
    if left:
        move_notes(session, left, session.outline.path_of(home.data), corner)


def _machine_in_machine(session: EditSession, home: NodeRef, ref: NodeRef, children: tuple[NodeRef, ...]) -> None:
    transitions = cast("Plain", ref.data.get("transitions") or {})
    initial = ref.body.get("initial")
    entry = next((child for child in children if child.name == initial), children[0])
    corner = _point(session, ref)
    points = {id(child.data): _point(session, child) for child in children}
    follow = ReferenceUpdate(session)
    names = _put_in_place(session, home, ref, children)
    follow.finish(
        instead={id(ref.data): names[id(entry.data)]},
        dangling=lambda _, target: cast("str | None", transitions.get(target)),
    )
    _place(session, children, points, corner)
    for child in children:
        session.mark(child.data)


def _put_in_place(session: EditSession, home: NodeRef, ref: NodeRef, children: tuple[NodeRef, ...]) -> dict[int, str]:
    """Insert children at the position of their container; return their names by the id of their data."""
    taken = {child.name for child in session.outline.children(home)} - {ref.name}
    taken |= set(session.outcomes_inside(home))
    names: dict[int, str] = {}
    for child in children:
        number, name = 2, child.name
        while name in taken:
            name, number = f"{child.name}_{number}", number + 1
        taken.add(name)
        names[id(child.data)] = name
    states = named_children(home)
    kept: Plain = {}
    for key, each in states.items():
        kept |= {names[id(child.data)]: child.data for child in children} if key == ref.name else {key: each}
    for child in children:
        named_children(ref).pop(child.name, None)
    states.clear()
    states.update(kept)
    return names


def _tree_in_machine(session: EditSession, home: NodeRef, ref: NodeRef) -> None:
    """Convert a plain sequence or selector to states connected by transitions."""
    (part,) = session.outline.children(ref)
    steps = session.outline.children(part)
    if part.kind not in ("sequence", "selector") or not steps or any(step.is_part for step in steps):
        hint = "only a sequence or selector of states and containers can be converted"
        raise EditRefused(f"`{ref.path}` cannot be converted to connected states", hint=hint)
    if isinstance(part.data.get(part.kind), dict) and part.body.get("memory") is False:
        raise EditRefused(
            f"`{part.path}` has no memory",
            hint="only a composite with memory executes its children one after the other",
        )
    if any("post" in step.data for step in steps):
        raise EditRefused(f"a step of `{ref.path}` has a `post`, which would be lost", hint="remove it first")
    if any(_guard(step).get("to") == "skipped" for step in steps):
        raise EditRefused(
            f"a step of `{ref.path}` may be skipped, which a machine does not support", hint="change its guard"
        )
    transitions = cast("Plain", ref.data.get("transitions") or {})
    ends = {id(step.data): session.ends(step) for step in steps}
    follow = ReferenceUpdate(session)
    taken = {child.name for child in session.outline.children(home)} - {ref.name} | set(session.outcomes_inside(home))
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
            onto = names[number + 1] if status == onward and number + 1 < len(steps) else transitions.get(status)
            if onto is not None:
                wired[outcome] = onto
        if step.data.get("disabled"):
            step.data["disabled"] = _passing(step, ends[id(step.data)].outcomes, good, onward)
        _divert(step.data, transitions)
        if wired:
            step.data["transitions"] = wired
    states = named_children(home)
    kept: Plain = {}
    for key, each in states.items():
        kept |= dict(zip(names, [s.data for s in steps], strict=True)) if key == ref.name else {key: each}
    states.clear()
    states.update(kept)
    follow.finish(instead={id(ref.data): names[0]}, dangling=lambda _, target: target)
    for step in steps:
        session.mark(step.data)


def _passing(step: NodeRef, outcomes: tuple[str, ...], good: tuple[str, ...], onward: str) -> str:
    """Return the outcome by which a disabled step of a sequence or selector is passed over in a machine."""
    outcome = next((each for each in outcomes if (each in good) == (onward == "success")), None)
    if outcome is None:
        hint = "enable it, or remove it first"
        raise EditRefused(f"`{step.path}` is disabled, and no outcome of it leads to the next step", hint=hint)
    return outcome


def _guard(ref: NodeRef) -> Plain:
    guard = ref.data.get("guard")
    return cast("Plain", guard) if isinstance(guard, dict) else {}


def _divert(node: Plain, transitions: Plain) -> None:
    """Connect timeout, guard and on_error of a former tree leaf to the targets of its status."""
    for key in ("timeout", "guard"):
        measure = node.get(key)
        if isinstance(measure, dict) and isinstance(cast("Plain", measure).get("to"), str):
            found = cast("Plain", measure)
            found["to"] = transitions.get(str(found["to"]), found["to"])
    if isinstance(node.get("on_error"), str):
        node["on_error"] = transitions.get(str(node["on_error"]), node["on_error"])


def _in_tree(session: EditSession, home: NodeRef, ref: NodeRef, children: tuple[NodeRef, ...]) -> None:
    if not ref.is_part:
        raise EditRefused(f"a {ref.kind} cannot be converted to tree nodes", hint="ungroup composites and decorators")
    if len(children) > 1 and (home.kind != ref.kind or ref.kind == "parallel" or ref.kind in SLOTS):
        raise EditRefused(f"ungrouping a {ref.kind} in a {home.kind} changes its meaning", hint="change its kind first")
    first = next(iter(children))
    follow = ReferenceUpdate(session)
    if home.kind in GROUPS:
        body = home.data[home.kind]
        listed = cast("list[object]", body if isinstance(body, list) else cast("Plain", body)["children"])
        place = next(number for number, each in enumerate(listed) if each is ref.data)
        listed[place : place + 1] = [child.data for child in children]
    elif home.kind == "tree":
        home.data["tree"] = first.data
    else:
        home.body[ref.role or "child"] = first.data
    follow.finish()
    for child in children:
        session.mark(child.data)


def _only_one(session: EditSession, home: NodeRef, ref: NodeRef, child: NodeRef) -> None:
    wired = cast("Plain", child.data.get("transitions") or {})
    if any(outcome != to for outcome, to in wired.items()):
        hint = "connect each outcome to an outcome of the same name first"
        raise EditRefused(f"the outcomes of `{ref.path}` and of `{child.name}` have different names", hint=hint)
    follow = ReferenceUpdate(session)
    if home.kind in NAMED:
        states = named_children(home)
        kept = {key: child.data if each is ref.data else each for key, each in states.items()}
        states.clear()
        states.update(kept)
        name = ref.name
    else:
        home.body["child"] = child.data
        name = "child"
    follow.finish(instead={id(ref.data): name}, dangling=lambda _, target: target)
    child.data.pop("transitions", None)
    session.mark(child.data)


def _point(session: EditSession, ref: NodeRef) -> tuple[float, float] | None:
    view = session.draft.data.get("view")
    point = cast("Plain", view).get(ref.path) if isinstance(view, dict) else None
    if not isinstance(point, list) or len(cast("list[float]", point)) != 2:
        return None
    x, y = cast("list[float]", point)
    return (x, y)


def _place(
    session: EditSession,
    children: tuple[NodeRef, ...],
    points: dict[int, tuple[float, float] | None],
    corner: tuple[float, float] | None,
) -> None:
    positions: dict[str, CanvasPoint | None] = {}
    for child in children:
        point = points[id(child.data)]
        if point is not None and corner is not None:
            positions[session.outline.path_of(child.data)] = (point[0] + corner[0], point[1] + corner[1])
    if positions:
        set_positions(session, SetPositions(positions=positions))

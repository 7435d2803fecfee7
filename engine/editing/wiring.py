"""Edits of what follows what: transitions, the initial child, outcomes that obviously go somewhere."""

from __future__ import annotations

from typing import cast

from engine.editing.bench import Bench
from engine.editing.draft import EditRefused
from engine.editing.edit import AutoConnect, ClearTransition, SetInitial, SetTransition
from engine.editing.outline import MACHINES, Plain, Spot
from engine.nearness import near_names


def set_transition(bench: Bench, edit: SetTransition) -> None:
    """Lead an outcome of a node somewhere."""
    spot = bench.at(edit.path)
    machine = _machine_around(spot)
    if edit.target == machine.name and machine.parent is not None and edit.target not in _names(bench, machine):
        raise EditRefused(f"`{edit.target}` is the container itself", hint="lead to one of its children or outcomes")
    connect(bench, spot, edit.outcome, edit.target)


def clear_transition(bench: Bench, edit: ClearTransition) -> None:
    """Lead an outcome of a node nowhere."""
    spot = bench.at(edit.path)
    wired = spot.data.get("transitions")
    if not isinstance(wired, dict) or edit.outcome not in wired:
        known = cast("Plain", wired) if isinstance(wired, dict) else {}
        raise EditRefused(f"`{edit.outcome}` of `{spot.path}` leads nowhere", hint=near_names(edit.outcome, known))
    transitions = cast("Plain", wired)
    del transitions[edit.outcome]
    if not transitions:
        del spot.data["transitions"]
    bench.mark(spot.data)


def set_initial(bench: Bench, edit: SetInitial) -> None:
    """Let a machine begin with a child."""
    spot = bench.at(edit.path)
    if spot.kind not in MACHINES:
        raise EditRefused(f"`{spot.path}` is no machine", hint="only machines begin with a child")
    if edit.child not in _names(bench, spot):
        raise EditRefused(
            f"`{spot.path}` has no child `{edit.child}`", hint=near_names(edit.child, _names(bench, spot))
        )
    begin_with(spot, edit.child)
    bench.mark(spot.data)


def auto_connect(bench: Bench, edit: AutoConnect) -> None:
    """Lead the open outcomes of nodes where they obviously go."""
    for path in edit.paths:
        spot = bench.at(path)
        if spot.kind in MACHINES:
            for child in bench.outline.children(spot):
                _connect_open(bench, child)
        elif spot.parent is not None and spot.parent.kind in MACHINES:
            _connect_open(bench, spot)
        else:
            raise EditRefused(f"`{path}` is neither a machine nor in one", hint="only there outcomes lead somewhere")


def connect(bench: Bench, spot: Spot, outcome: str, target: str) -> None:
    """Write one transition of a node."""
    if not isinstance(spot.data.get("transitions"), dict):
        spot.data["transitions"] = {}
    cast("Plain", spot.data["transitions"])[outcome] = target
    bench.mark(spot.data)


def begin_with(machine: Spot, child: str) -> None:
    """Write the initial child of a machine, in front of its states."""
    body = machine.body
    if "initial" in body:
        body["initial"] = child
        return
    kept = dict(body)
    body.clear()
    body.update({"initial": child, **kept})


def open_ends(bench: Bench, spot: Spot) -> list[str]:
    """Return the outcomes of a child of a machine that lead nowhere."""
    wired = spot.data.get("transitions")
    known = cast("Plain", wired) if isinstance(wired, dict) else {}
    return [outcome for outcome in bench.ends(spot).outcomes if outcome not in known]


def _connect_open(bench: Bench, spot: Spot) -> None:
    """Good outcomes go on to the next sibling, or out by the good outcome; the others go out by their own name."""
    machine = _machine_around(spot)
    ends, outside = bench.ends(spot), bench.outcomes_inside(machine)
    siblings = [child.name for child in bench.outline.children(machine)]
    onward = siblings[siblings.index(spot.name) + 1 :][:1]
    good = [name for name in _good_outside(bench, machine) if name in outside]
    bad = [name for name in outside if name not in good]
    for outcome in open_ends(bench, spot):
        to = outcome if outcome in outside else None
        if outcome in ends.success:
            to = next(iter((*onward, *([to] if to else []), *good, *outside)), None)
        elif to is None:
            to = next((name for name in ("failed", "failure") if name in bad), bad[0] if len(bad) == 1 else None)
        if to is not None:
            connect(bench, spot, outcome, to)


def _good_outside(bench: Bench, machine: Spot) -> tuple[str, ...]:
    listed = bench.draft.data.get("success") if machine.parent is None else None
    if isinstance(listed, list):
        return tuple(str(each) for each in cast("list[object]", listed))
    return bench.ends(machine).success


def _machine_around(spot: Spot) -> Spot:
    machine = spot.parent
    if machine is None or machine.kind not in MACHINES:
        around = f"in a {machine.kind}" if machine is not None else "outermost"
        hint = "in a concurrency container `conditions` say what follows, in a tree success and failure do"
        raise EditRefused(f"`{spot.path}` is {around}, so its outcomes lead nowhere", hint=hint)
    return machine


def _names(bench: Bench, spot: Spot) -> list[str]:
    return [child.name for child in bench.outline.children(spot)]

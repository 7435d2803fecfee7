"""Edits of control flow: transitions, the initial child, open outcomes with an evident target."""

from __future__ import annotations

from typing import cast

from engine.document.nodes.node_kind import MACHINES
from engine.editing.edits.edit import AutoConnect, ClearTransition, SetInitial, SetTransition
from engine.editing.edits.edit_session import EditSession
from engine.editing.text.draft import EditRefused
from engine.editing.text.outline import NodeRef, Plain
from engine.wording.suggestions import did_you_mean


def set_transition(session: EditSession, edit: SetTransition) -> None:
    """Connect an outcome of a node."""
    ref = session.at(edit.path)
    machine = _machine_around(ref)
    if edit.target == machine.name and machine.parent is not None and edit.target not in _names(session, machine):
        raise EditRefused(f"`{edit.target}` is the container itself", hint="connect to one of its children or outcomes")
    connect(session, ref, edit.outcome, edit.target)


def clear_transition(session: EditSession, edit: ClearTransition) -> None:
    """Remove the transition of an outcome of a node."""
    ref = session.at(edit.path)
    wired = ref.data.get("transitions")
    if not isinstance(wired, dict) or edit.outcome not in wired:
        known = cast("Plain", wired) if isinstance(wired, dict) else {}
        raise EditRefused(f"`{edit.outcome}` of `{ref.path}` has no transition", hint=did_you_mean(edit.outcome, known))
    transitions = cast("Plain", wired)
    del transitions[edit.outcome]
    if not transitions:
        del ref.data["transitions"]
    session.mark(ref.data)


def set_initial(session: EditSession, edit: SetInitial) -> None:
    """Set the initial child of a machine."""
    ref = session.at(edit.path)
    if ref.kind not in MACHINES:
        raise EditRefused(f"`{ref.path}` is not a machine", hint="only machines have an initial child")
    if edit.child not in _names(session, ref):
        raise EditRefused(
            f"`{ref.path}` has no child `{edit.child}`", hint=did_you_mean(edit.child, _names(session, ref))
        )
    write_initial(ref, edit.child)
    session.mark(ref.data)


def auto_connect(session: EditSession, edit: AutoConnect) -> None:
    """Connect the open outcomes of nodes to their evident targets."""
    for path in edit.paths:
        ref = session.at(path)
        if ref.kind in MACHINES:
            for child in session.outline.children(ref):
                _connect_open(session, child)
        elif ref.parent is not None and ref.parent.kind in MACHINES:
            _connect_open(session, ref)
        else:
            raise EditRefused(
                f"`{path}` is neither a machine nor in one", hint="only nodes of a machine have transitions"
            )


def connect(session: EditSession, ref: NodeRef, outcome: str, target: str) -> None:
    """Write one transition of a node."""
    if not isinstance(ref.data.get("transitions"), dict):
        ref.data["transitions"] = {}
    cast("Plain", ref.data["transitions"])[outcome] = target
    session.mark(ref.data)


def write_initial(machine: NodeRef, child: str) -> None:
    """Write the initial child of a machine, before its states."""
    body = machine.body
    if "initial" in body:
        body["initial"] = child
        return
    kept = dict(body)
    body.clear()
    body.update({"initial": child, **kept})


def unconnected_outcomes(session: EditSession, ref: NodeRef) -> list[str]:
    """Return the outcomes of a child of a machine without transition."""
    wired = ref.data.get("transitions")
    known = cast("Plain", wired) if isinstance(wired, dict) else {}
    return [outcome for outcome in session.ends(ref).outcomes if outcome not in known]


def _connect_open(session: EditSession, ref: NodeRef) -> None:
    """Connect success outcomes to the next sibling or the success outcome, the others to the outcome of their name."""
    machine = _machine_around(ref)
    ends, outside = session.ends(ref), session.outcomes_inside(machine)
    siblings = [child.name for child in session.outline.children(machine)]
    onward = siblings[siblings.index(ref.name) + 1 :][:1]
    good = [name for name in _good_outside(session, machine) if name in outside]
    bad = [name for name in outside if name not in good]
    for outcome in unconnected_outcomes(session, ref):
        to = outcome if outcome in outside else None
        if outcome in ends.success:
            to = next(iter((*onward, *([to] if to else []), *good, *outside)), None)
        elif to is None:
            to = next((name for name in ("failed", "failure") if name in bad), bad[0] if len(bad) == 1 else None)
        if to is not None:
            connect(session, ref, outcome, to)


def _good_outside(session: EditSession, machine: NodeRef) -> tuple[str, ...]:
    listed = session.draft.data.get("success") if machine.parent is None else None
    if isinstance(listed, list):
        return tuple(str(each) for each in cast("list[object]", listed))
    return session.ends(machine).success


def _machine_around(ref: NodeRef) -> NodeRef:
    machine = ref.parent
    if machine is None or machine.kind not in MACHINES:
        around = f"in a {machine.kind}" if machine is not None else "the outermost node"
        hint = "in a concurrency container `conditions` define what follows, in a tree success and failure do"
        raise EditRefused(f"`{ref.path}` is {around}, so its outcomes have no transitions", hint=hint)
    return machine


def _names(session: EditSession, ref: NodeRef) -> list[str]:
    return [child.name for child in session.outline.children(ref)]

"""Fixes of transitions: unconnected outcomes, missing targets, unreachable nodes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import cast

from engine.document.nodes.concurrency_condition import PREEMPT, deciding, read_entry
from engine.editing.edits.edit import (
    AnyEdit,
    ClearTransition,
    RemoveNodes,
    RenameNode,
    SetDocument,
    SetField,
    SetInitial,
    SetTransition,
)
from engine.editing.fixes.fix import Fix, FixContext, is_typo, mapping, similar_names, strings, with_renamed_key
from engine.editing.project_context import rules
from engine.editing.text.outline import Plain


def unconnected(place: FixContext) -> Iterator[Fix]:
    """Connect an outcome: by its name, to the next node, or out; or declare it as an outcome of the behavior."""
    outcome = place.names[0]
    if place.ref.parent is None:
        listed = strings(place.session.draft.data.get("outcomes"))
        yield Fix(
            title=f"Add `{outcome}` to the outcomes of the behavior",
            edits=(SetDocument(changes={"outcomes": [*listed, outcome]}),),
        )
        return
    for target in _targets(place, outcome):
        sure = target == outcome and target in place.machine_outcomes
        yield Fix(title=f"Connect `{outcome}` to `{target}`", edits=(_lead(place, outcome, target),), sure=sure)


def _targets(place: FixContext, outcome: str) -> list[str]:
    """Return the possible targets of an outcome, the likeliest first: success to the next node, the others out."""
    machine = place.machine
    if machine is None:
        return []
    names = [child.name for child in place.session.outline.children(machine)]
    onward = names[names.index(place.ref.name) + 1 :][:1]
    same = [name for name in place.machine_outcomes if name == outcome]
    good = _good(place)
    well = [name for name in place.machine_outcomes if name in good]
    badly = [name for name in place.machine_outcomes if name not in good]
    is_good = outcome in place.session.ends(place.ref).success
    ordered = [*onward, *same, *well, *badly] if is_good else [*same, *badly, *onward, *well]
    return list(dict.fromkeys((*ordered, *place.siblings)))


def _good(place: FixContext) -> tuple[str, ...]:
    machine = place.machine
    if machine is None:
        return ()
    if machine.parent is None:
        return tuple(strings(place.session.draft.data.get("success")))
    return place.session.ends(machine).success


def _lead(place: FixContext, outcome: str, target: str) -> SetTransition:
    return SetTransition(path=place.ref.path, outcome=outcome, target=target)


def unknown_outcome(place: FixContext) -> Iterator[Fix]:
    """Replace an unknown outcome with one of the node, or remove the reference."""
    if len(place.names) < 2:
        return
    name, outcome = place.names[:2]
    if outcome in place.section("transitions") and name == place.ref.name:
        yield from _other_outcome(place, outcome)
        return
    of = next((each for each in place.session.outline.children(place.ref) if each.name == name), place.ref)
    known = place.session.ends(of).outcomes
    for right in similar_names(outcome, known):
        edit = _replaced(place, name, outcome, right)
        if edit is not None:
            title = f"Write `{right}` instead of `{outcome}`"
            yield Fix(title=title, edits=(edit,), sure=is_typo(outcome, right, known))


def _other_outcome(place: FixContext, outcome: str) -> Iterator[Fix]:
    target = place.section("transitions").get(outcome)
    known = place.session.ends(place.ref).outcomes
    for right in similar_names(outcome, known):
        if right not in place.section("transitions") and isinstance(target, str):
            edits = (ClearTransition(path=place.ref.path, outcome=outcome), _lead(place, right, target))
            title = f"Connect `{right}` instead of `{outcome}`"
            yield Fix(title=title, edits=edits, sure=is_typo(outcome, right, known))
    yield _disconnected(place, outcome)


def _disconnected(place: FixContext, outcome: str) -> Fix:
    edit = ClearTransition(path=place.ref.path, outcome=outcome)
    return Fix(title=f"Remove the transition of `{outcome}`", edits=(edit,))


def _replaced(place: FixContext, name: str, old: str, new: str) -> AnyEdit | None:
    """Return the edit that writes another outcome where autonomy, retry, success, next or a condition names it."""
    path, data = place.ref.path, place.ref.data
    if old in place.section("autonomy"):
        return SetField(path=path, field="autonomy", value=with_renamed_key(place.section("autonomy"), old, new))
    retry = place.section("retry")
    if old in strings(retry.get("outcomes")):
        return SetField(path=path, field="retry", value={**retry, "outcomes": _swapped(retry["outcomes"], old, new)})
    if old in strings(data.get("success")):
        return SetField(path=path, field="success", value=_swapped(data["success"], old, new))
    if place.ref.kind == "foreach" and old in strings(place.ref.body.get("next")):
        return SetField(path=path, field="next", value=_swapped(place.ref.body["next"], old, new))
    if place.ref.kind == "concurrency":
        conditions = _rules(place, lambda when: {**when, name: new} if when.get(name) == old else when)
        return SetField(path=path, field="conditions", value=conditions)
    return None


def _swapped(listed: object, old: str, new: str) -> list[object]:
    return [new if each == old else each for each in cast("list[object]", listed)]


def unused_outcome(place: FixContext) -> Iterator[Fix]:
    """Remove an outcome that is never reached, from the behavior or from transitions."""
    outcome = place.names[-1]
    if len(place.names) > 1:
        yield from _other_outcome(place, outcome)
        return
    data = place.session.draft.data
    listed, good = strings(data.get("outcomes")), strings(data.get("success"))
    if outcome in listed and len(listed) > 1:
        changes: dict[str, object] = {"outcomes": [each for each in listed if each != outcome]}
        if outcome in good:
            changes["success"] = [each for each in good if each != outcome] or None
        yield Fix(title=f"Remove the outcome `{outcome}`", edits=(SetDocument(changes=changes),))


def unknown_target(place: FixContext) -> Iterator[Fix]:
    """Change the target, or declare the name as an outcome of the behavior."""
    target = place.names[0]
    others = [name for name in place.machine_outcomes if name != target]
    known = (*place.siblings, place.ref.name, *others)
    outcomes = [outcome for outcome, to in place.section("transitions").items() if to == target]
    for right in dict.fromkeys((*similar_names(target, known), *others[:2])):
        edits: list[AnyEdit] = [_lead(place, outcome, right) for outcome in outcomes]
        for key in ("timeout", "guard"):
            measure = place.section(key)
            if measure.get("to") == target:
                edits.append(SetField(path=place.ref.path, field=key, value={**measure, "to": right}))
        if place.ref.data.get("on_error") == target:
            edits.append(SetField(path=place.ref.path, field="on_error", value=right))
        if edits:
            title = f"Connect to `{right}` instead of `{target}`"
            yield Fix(title=title, edits=tuple(edits), sure=is_typo(target, right, known))
    if place.machine is not None and place.machine.parent is None:
        listed = strings(place.session.draft.data.get("outcomes"))
        yield Fix(
            title=f"Make `{target}` an outcome of the behavior",
            edits=(SetDocument(changes={"outcomes": [*listed, target]}),),
        )


def missing_initial(place: FixContext) -> Iterator[Fix]:
    """Set the initial state to an existing child."""
    names = [child.name for child in place.session.outline.children(place.ref)]
    for name in dict.fromkeys((*similar_names(place.names[0], names), *names)):
        sure = len(names) == 1 or is_typo(place.names[0], name, names)
        yield Fix(title=f"Begin with `{name}`", edits=(SetInitial(path=place.ref.path, child=name),), sure=sure)


def unreachable(place: FixContext) -> Iterator[Fix]:
    """Delete an unreachable node."""
    if place.machine is not None:
        inside = len(place.session.outline.children(place.ref))
        more = " and all nodes inside it" if inside else ""
        yield Fix(title=f"Delete `{place.ref.name}`{more}", edits=(RemoveNodes(paths=(place.ref.path,)),))


def ambiguous(place: FixContext) -> Iterator[Fix]:
    """Rename a state that has the name of an outcome."""
    if place.machine is not None:
        name = place.session.free_name(place.machine, f"{place.ref.name}_state")
        edit = RenameNode(path=place.ref.path, name=name)
        yield Fix(title=f"Rename the state `{place.ref.name}` to `{name}`", edits=(edit,))


def unknown_child(place: FixContext) -> Iterator[Fix]:
    """Replace an unknown child in a condition, or in its `preempt`, with an existing one."""
    name = place.names[0]
    names = [child.name for child in place.session.outline.children(place.ref)]
    for right in similar_names(name, names):
        conditions = _rules(
            place,
            lambda when, right=right: with_renamed_key(when, name, right),
            lambda listed, right=right: _swapped(listed, name, right),
        )
        edit = SetField(path=place.ref.path, field="conditions", value=conditions)
        yield Fix(title=f"Write `{right}` instead of `{name}`", edits=(edit,), sure=is_typo(name, right, names))


def preempts_itself(place: FixContext) -> Iterator[Fix]:
    """Remove a child that has ended when a condition is true from its `preempt`, and `preempt` with the last one."""
    name = place.names[0]
    kept: list[object] = []
    for entry in _entries(place):
        rule = read_entry(entry)
        if rule is None or name not in rule.when or name not in rule.preempt or not rule.needs_all:
            kept.append(entry)
        elif others := [child for child in rule.preempt if child != name]:
            kept.append({**entry, PREEMPT: others})
    edit = SetField(path=place.ref.path, field="conditions", value=kept)
    yield Fix(title=f"Do not preempt `{name}`", edits=(edit,))


def uncovered(place: FixContext) -> Iterator[Fix]:
    """Set the outcome of a concurrency container for the case that no condition is true."""
    for outcome in dict.fromkeys(rule.outcome for rule in deciding(rules(place.ref))):
        edit = SetField(path=place.ref.path, field="otherwise", value=outcome)
        yield Fix(title=f"Otherwise end with `{outcome}`", edits=(edit,))


def _rules(
    place: FixContext, change: Callable[[Plain], Plain], whom: Callable[[list[object]], list[object]] = list
) -> list[object]:
    """Return the conditions of a concurrency container, with what each asks for, and preempts, changed by functions."""
    return [{key: _changed(value, change, whom) for key, value in entry.items()} for entry in _entries(place)]


def _changed(
    value: object, change: Callable[[Plain], Plain], whom: Callable[[list[object]], list[object]]
) -> Plain | list[object]:
    return whom(cast("list[object]", value)) if isinstance(value, list) else change(mapping(value))


def _entries(place: FixContext) -> list[Plain]:
    return [mapping(entry) for entry in cast("list[object]", place.ref.body.get("conditions") or [])]

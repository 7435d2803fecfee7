"""Fixes of what follows what: outcomes that lead nowhere, targets that are not there, nodes nothing leads to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import cast

from engine.document.condition import PREEMPT, deciding, read_entry
from engine.editing.edit import (
    AnyEdit,
    ClearTransition,
    RemoveNodes,
    RenameNode,
    SetDocument,
    SetField,
    SetInitial,
    SetTransition,
)
from engine.editing.knowledge import rules
from engine.editing.mending.fix import Fix, Place, is_slip, mapping, near, renamed, strings
from engine.editing.outline import Plain


def unconnected(place: Place) -> Iterator[Fix]:
    """Connect an outcome: by its name, onward, or out; or declare it where it is one of the root."""
    outcome = place.names[0]
    if place.spot.parent is None:
        listed = strings(place.bench.draft.data.get("outcomes"))
        yield Fix(
            title=f"Add `{outcome}` to the outcomes of the behavior",
            edits=(SetDocument(changes={"outcomes": [*listed, outcome]}),),
        )
        return
    for target in _targets(place, outcome):
        sure = target == outcome and target in place.leaving
        yield Fix(title=f"Connect `{outcome}` to `{target}`", edits=(_lead(place, outcome, target),), sure=sure)


def _targets(place: Place, outcome: str) -> list[str]:
    """Return where an outcome may lead, the likeliest first: good ones onward, the others out."""
    machine = place.machine
    if machine is None:
        return []
    names = [child.name for child in place.bench.outline.children(machine)]
    onward = names[names.index(place.spot.name) + 1 :][:1]
    same = [name for name in place.leaving if name == outcome]
    good = _good(place)
    well = [name for name in place.leaving if name in good]
    badly = [name for name in place.leaving if name not in good]
    is_good = outcome in place.bench.ends(place.spot).success
    ordered = [*onward, *same, *well, *badly] if is_good else [*same, *badly, *onward, *well]
    return list(dict.fromkeys((*ordered, *place.siblings)))


def _good(place: Place) -> tuple[str, ...]:
    machine = place.machine
    if machine is None:
        return ()
    if machine.parent is None:
        return tuple(strings(place.bench.draft.data.get("success")))
    return place.bench.ends(machine).success


def _lead(place: Place, outcome: str, target: str) -> SetTransition:
    return SetTransition(path=place.spot.path, outcome=outcome, target=target)


def unknown_outcome(place: Place) -> Iterator[Fix]:
    """Take an outcome that the node has, or drop what names another one."""
    if len(place.names) < 2:
        return
    name, outcome = place.names[:2]
    if outcome in place.section("transitions") and name == place.spot.name:
        yield from _other_outcome(place, outcome)
        return
    of = next((each for each in place.bench.outline.children(place.spot) if each.name == name), place.spot)
    known = place.bench.ends(of).outcomes
    for right in near(outcome, known):
        edit = _replaced(place, name, outcome, right)
        if edit is not None:
            title = f"Write `{right}` instead of `{outcome}`"
            yield Fix(title=title, edits=(edit,), sure=is_slip(outcome, right, known))


def _other_outcome(place: Place, outcome: str) -> Iterator[Fix]:
    target = place.section("transitions").get(outcome)
    known = place.bench.ends(place.spot).outcomes
    for right in near(outcome, known):
        if right not in place.section("transitions") and isinstance(target, str):
            edits = (ClearTransition(path=place.spot.path, outcome=outcome), _lead(place, right, target))
            title = f"Connect `{right}` instead of `{outcome}`"
            yield Fix(title=title, edits=edits, sure=is_slip(outcome, right, known))
    yield _disconnected(place, outcome)


def _disconnected(place: Place, outcome: str) -> Fix:
    edit = ClearTransition(path=place.spot.path, outcome=outcome)
    return Fix(title=f"Remove the transition of `{outcome}`", edits=(edit,))


def _replaced(place: Place, name: str, old: str, new: str) -> AnyEdit | None:
    """Return the edit that writes another outcome where autonomy, retry, success, next or a condition names it."""
    path, data = place.spot.path, place.spot.data
    if old in place.section("autonomy"):
        return SetField(path=path, field="autonomy", value=renamed(place.section("autonomy"), old, new))
    retry = place.section("retry")
    if old in strings(retry.get("outcomes")):
        return SetField(path=path, field="retry", value={**retry, "outcomes": _swapped(retry["outcomes"], old, new)})
    if old in strings(data.get("success")):
        return SetField(path=path, field="success", value=_swapped(data["success"], old, new))
    if place.spot.kind == "foreach" and old in strings(place.spot.body.get("next")):
        return SetField(path=path, field="next", value=_swapped(place.spot.body["next"], old, new))
    if place.spot.kind == "concurrency":
        conditions = _rules(place, lambda when: {**when, name: new} if when.get(name) == old else when)
        return SetField(path=path, field="conditions", value=conditions)
    return None


def _swapped(listed: object, old: str, new: str) -> list[object]:
    return [new if each == old else each for each in cast("list[object]", listed)]


def unused_outcome(place: Place) -> Iterator[Fix]:
    """Remove an outcome that nothing leads to, of the behavior or from transitions."""
    outcome = place.names[-1]
    if len(place.names) > 1:
        yield from _other_outcome(place, outcome)
        return
    data = place.bench.draft.data
    listed, good = strings(data.get("outcomes")), strings(data.get("success"))
    if outcome in listed and len(listed) > 1:
        changes: dict[str, object] = {"outcomes": [each for each in listed if each != outcome]}
        if outcome in good:
            changes["success"] = [each for each in good if each != outcome] or None
        yield Fix(title=f"Remove the outcome `{outcome}`", edits=(SetDocument(changes=changes),))


def unknown_target(place: Place) -> Iterator[Fix]:
    """Lead elsewhere, or make the name an outcome of the behavior."""
    target = place.names[0]
    leaving = [name for name in place.leaving if name != target]
    known = (*place.siblings, place.spot.name, *leaving)
    ways = [outcome for outcome, to in place.section("transitions").items() if to == target]
    for right in dict.fromkeys((*near(target, known), *leaving[:2])):
        edits: list[AnyEdit] = [_lead(place, outcome, right) for outcome in ways]
        for key in ("timeout", "guard"):
            measure = place.section(key)
            if measure.get("to") == target:
                edits.append(SetField(path=place.spot.path, field=key, value={**measure, "to": right}))
        if place.spot.data.get("on_error") == target:
            edits.append(SetField(path=place.spot.path, field="on_error", value=right))
        if edits:
            title = f"Lead to `{right}` instead of `{target}`"
            yield Fix(title=title, edits=tuple(edits), sure=is_slip(target, right, known))
    if place.machine is not None and place.machine.parent is None:
        listed = strings(place.bench.draft.data.get("outcomes"))
        yield Fix(
            title=f"Make `{target}` an outcome of the behavior",
            edits=(SetDocument(changes={"outcomes": [*listed, target]}),),
        )


def missing_initial(place: Place) -> Iterator[Fix]:
    """Begin with a child that there is."""
    names = [child.name for child in place.bench.outline.children(place.spot)]
    for name in dict.fromkeys((*near(place.names[0], names), *names)):
        sure = len(names) == 1 or is_slip(place.names[0], name, names)
        yield Fix(title=f"Begin with `{name}`", edits=(SetInitial(path=place.spot.path, child=name),), sure=sure)


def unreachable(place: Place) -> Iterator[Fix]:
    """Delete a node that nothing leads to."""
    if place.machine is not None:
        inside = len(place.bench.outline.children(place.spot))
        more = " and all that is in it" if inside else ""
        yield Fix(title=f"Delete `{place.spot.name}`{more}", edits=(RemoveNodes(paths=(place.spot.path,)),))


def ambiguous(place: Place) -> Iterator[Fix]:
    """Give a state that is called like an outcome another name."""
    if place.machine is not None:
        name = place.bench.free_name(place.machine, f"{place.spot.name}_state")
        edit = RenameNode(path=place.spot.path, name=name)
        yield Fix(title=f"Rename the state `{place.spot.name}` to `{name}`", edits=(edit,))


def unknown_child(place: Place) -> Iterator[Fix]:
    """Name a child that there is where a condition asks for, or preempts, one that is not."""
    name = place.names[0]
    names = [child.name for child in place.bench.outline.children(place.spot)]
    for right in near(name, names):
        conditions = _rules(
            place,
            lambda when, right=right: renamed(when, name, right),
            lambda listed, right=right: _swapped(listed, name, right),
        )
        edit = SetField(path=place.spot.path, field="conditions", value=conditions)
        yield Fix(title=f"Write `{right}` instead of `{name}`", edits=(edit,), sure=is_slip(name, right, names))


def preempts_itself(place: Place) -> Iterator[Fix]:
    """Leave a child that has ended when a condition holds out of those that it preempts; it goes with the last one."""
    name = place.names[0]
    kept: list[object] = []
    for entry in _entries(place):
        rule = read_entry(entry)
        if rule is None or name not in rule.when or name not in rule.preempt or not rule.needs_all:
            kept.append(entry)
        elif others := [child for child in rule.preempt if child != name]:
            kept.append({**entry, PREEMPT: others})
    edit = SetField(path=place.spot.path, field="conditions", value=kept)
    yield Fix(title=f"Do not preempt `{name}`", edits=(edit,))


def uncovered(place: Place) -> Iterator[Fix]:
    """Say how a concurrency container ends when no condition holds."""
    for outcome in dict.fromkeys(rule.outcome for rule in deciding(rules(place.spot))):
        edit = SetField(path=place.spot.path, field="otherwise", value=outcome)
        yield Fix(title=f"Otherwise end with `{outcome}`", edits=(edit,))


def _rules(
    place: Place, change: Callable[[Plain], Plain], whom: Callable[[list[object]], list[object]] = list
) -> list[object]:
    """Return the conditions of a concurrency container, with what each asks for, and preempts, changed by functions."""
    return [{key: _changed(value, change, whom) for key, value in entry.items()} for entry in _entries(place)]


def _changed(
    value: object, change: Callable[[Plain], Plain], whom: Callable[[list[object]], list[object]]
) -> Plain | list[object]:
    return whom(cast("list[object]", value)) if isinstance(value, list) else change(mapping(value))


def _entries(place: Place) -> list[Plain]:
    return [mapping(entry) for entry in cast("list[object]", place.spot.body.get("conditions") or [])]

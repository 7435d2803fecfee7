"""Finds numbers so large that they are probably in another unit: degrees for radians, millimetres for metres."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding, new_finding
from engine.check.values.annotated_values import annotated_lists, is_annotated
from engine.check.values.known_values import known_part
from engine.document.expression.expression import Template
from engine.document.parameter_spec import ParameterSpec


@dataclass(frozen=True, kw_only=True)
class _Unit:
    """A unit, the unit it is confused with, and the largest plausible number alone or in a list."""

    other: str
    factor: float
    alone: float
    in_list: float


MOST_TURNS_RAD = 2.5 * math.pi
"""More than the range of any arm joint in one direction."""
_UNITS: Mapping[str, _Unit] = {
    "rad": _Unit(other="degrees", factor=math.pi / 180.0, alone=MOST_TURNS_RAD, in_list=MOST_TURNS_RAD),
    # Positions in a hall are larger than the width of a gripper.
    "m": _Unit(other="millimetres", factor=0.001, alone=10.0, in_list=30.0),
    "m/s": _Unit(other="millimetres per second", factor=0.001, alone=10.0, in_list=30.0),
}
_SMALLEST_LIMIT = min(each.alone for each in _UNITS.values())


@dataclass(frozen=True, kw_only=True)
class UnitSuspicion:
    """A number, or a list of numbers, that is probably in another unit; `steps` lead to it."""

    steps: tuple[str | int, ...]
    message: str
    hint: str


def unit_suspicions(annotation: Any, value: object, *, name: str = "") -> Iterator[UnitSuspicion]:
    """Yield the numbers that are probably in another unit than their type declares, once per list.

    Args:
        annotation: The type.
        value: Plain data.
        name: Name of the whole value.
    """
    for steps, found in annotated_lists(annotation, value):
        inner = next((step for step in reversed(steps) if isinstance(step, str)), name)
        suspicion = unit_suspicion(inner, [each.value for each in found], found[0].says.get("unit"), steps=steps)
        if suspicion is not None:
            yield suspicion


def unit_suspicion(
    name: str, values: Sequence[object], unit: object, *, steps: tuple[str | int, ...] = ()
) -> UnitSuspicion | None:
    """Return the suspicion about numbers in a unit; None if they are plausible.

    Args:
        name: Their name.
        values: The single number, or all items of the list; items that are not numbers are ignored.
        unit: Their unit.
        steps: The keys that lead to the number, or to the list of them.
    """
    due = _UNITS.get(str(unit))
    numbers = [each for each in values if isinstance(each, int | float) and not isinstance(each, bool)]
    if due is None or not numbers:
        return None
    largest = max(numbers, key=abs)
    if not (due.in_list if len(values) > 1 else due.alone) < abs(largest) < math.inf:
        return None
    converted = ", ".join(f"{round(each * due.factor, 4):g}" for each in numbers)
    return UnitSuspicion(
        steps=steps,
        message=f"`{name}`: {largest:g} {unit} looks like {due.other}",
        hint=f"if so, write {converted if len(values) == 1 else f'[{converted}]'}",
    )


def check_magnitudes(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find numbers in a behavior that are probably in another unit than their parameter."""
    declared = subject.behavior.parameters
    for name, parameter in declared.items():
        found = unit_suspicion(name, [parameter.default], _unit(parameter)) if not parameter.required else None
        if found is not None:
            position = subject.behavior.source.position(("parameters", name, "default"))
            yield new_finding("suspect-unit", found.message, path=subject.base, position=position, hint=found.hint)
    for placed in subject.due:
        signature = subject.signature(placed.node)
        check = (check_magnitudes, signature.state if signature is not None else None)
        if check in placed.node.clear_of:
            continue
        suspicions = [(name, found) for name in placed.given for found in _given(subject, placed, name)]
        if not suspicions and signature is not None:
            placed.node.clear_of.add(check)
        for name, found in suspicions:
            keys = ("with", name, *found.steps)
            yield subject.finding("suspect-unit", found.message, placed.path, *keys, hint=found.hint)


def _given(subject: AnalyzedBehavior, placed: NodeAt, name: str) -> Iterator[UnitSuspicion]:
    given = placed.given[name]
    signature, referred = subject.signature(placed.node), subject.referred(placed.node)
    if signature is not None and name in signature.parameters:
        declared = signature.parameters[name].type
        if is_annotated(declared) and not (isinstance(given, Template) and given.constant and _is_small(given.value)):
            yield from unit_suspicions(declared, known_part(given, {}), name=name)
    elif referred is not None and name in referred.behavior.parameters:
        found = unit_suspicion(name, [known_part(given, {})], _unit(referred.behavior.parameters[name]))
        yield from [found] if found is not None else []


def _is_small(value: object) -> bool:
    """Return whether a single value is plausible in each unit, which most are."""
    return isinstance(value, int | float) and abs(value) <= _SMALLEST_LIMIT


def _unit(parameter: ParameterSpec) -> str:
    return parameter.unit.strip()

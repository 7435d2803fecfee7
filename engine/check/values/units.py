"""Checks that a behavior parameter passed to a node has the unit and the limits that the node requires."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, cast

from msgspec import inspect

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.flow.key_reads import only_name
from engine.document.parameter_spec import ParameterSpec

_NUMERIC = ("number", "integer")


@dataclass(frozen=True, kw_only=True)
class _Due:
    """What a parameter of a state or behavior requires of a number; exclusive limits count as inclusive."""

    unit: str = ""
    low: float = -math.inf
    high: float = math.inf


def check_units(subject: AnalyzedBehavior) -> Iterator[Finding]:
    """Find parameters of the behavior that are passed with another unit, without a unit, or out of range."""
    declared = subject.behavior.parameters
    if not declared:
        return
    for placed in subject.due:
        for name, found in placed.given.items():
            source = only_name(found)
            if source is None or source not in declared or declared[source].type not in _NUMERIC:
                continue
            due = _due(subject, placed, name)
            if due is not None:
                yield from _compare(subject, placed, name, source, declared[source], due)


def _compare(
    subject: AnalyzedBehavior, placed: NodeAt, name: str, source: str, parameter: ParameterSpec, due: _Due
) -> Iterator[Finding]:
    what = placed.node.state or placed.node.behavior
    path, keys = placed.path, ("with", name)
    if due.unit and not parameter.unit:
        message = f"`{name}` of `{what}` is in {due.unit}, but the parameter `{source}` has no unit"
        yield subject.finding("missing-unit", message, path, *keys, hint=f"declare it with `unit: {due.unit}`")
    elif due.unit and parameter.unit.strip() != due.unit:
        message = f"`{name}` of `{what}` is in {due.unit}, but the parameter `{source}` is in {parameter.unit}"
        hint = f"declare `{source}` in {due.unit}, or convert it in the expression"
        yield subject.finding("unit-mismatch", message, path, *keys, hint=hint)
    low, high = parameter.minimum, parameter.maximum
    too_low = low is not None and low < due.low
    too_high = high is not None and high > due.high
    if too_low or too_high:
        limit = f"minimum is {due.low:g}" if too_low else f"maximum is {due.high:g}"
        message = (
            f"the parameter `{source}` may be {low if too_low else high:g}, but for `{name}` of `{what}` the {limit}"
        )
        key = "minimum" if too_low else "maximum"
        hint = f"narrow `{key}` of `{source}`"
        yield subject.finding("range-too-wide", message, path, *keys, hint=hint)


def _due(subject: AnalyzedBehavior, placed: NodeAt, name: str) -> _Due | None:
    signature = subject.signature(placed.node)
    if signature is not None and name in signature.parameters:
        return _due_by_type(signature.parameters[name].type)
    referred = subject.referred(placed.node)
    inner = referred.behavior.parameters.get(name) if referred is not None else None
    if inner is None:
        return None
    low = inner.minimum if inner.minimum is not None else -math.inf
    high = inner.maximum if inner.maximum is not None else math.inf
    return _Due(unit=inner.unit.strip(), low=low, high=high)


@lru_cache(maxsize=1024)
def _due_by_type(annotation: Any) -> _Due:
    unit = ""
    low, high = -math.inf, math.inf
    due = [inspect.type_info(annotation)]
    while due:
        here = due.pop()
        if isinstance(here, inspect.Metadata):
            extra = cast("Mapping[str, object] | None", here.extra_json_schema)  # pyright: ignore[reportUnknownMemberType]
            unit = str(extra.get("unit", unit)) if extra else unit
            due.append(here.type)
        elif isinstance(here, inspect.UnionType):
            due += here.types
        elif isinstance(here, inspect.FloatType | inspect.IntType):
            lows = [value for value in (here.ge, here.gt) if value is not None]
            highs = [value for value in (here.le, here.lt) if value is not None]
            low, high = max(lows, default=low), min(highs, default=high)
    return _Due(unit=unit, low=low, high=high)

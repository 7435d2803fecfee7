"""States created before a run, with placeholders for parameters that are known only in the run."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any, cast

import msgspec

from engine.check.analyzed_behavior import NodeAt
from engine.document.expression.expression import Template
from engine.document.signature import StateSignature
from engine.errors import ExpressionError
from engine.state import State

UNKNOWN_PLACEHOLDER = "\0unknown"
"""Placeholder for values that are known only in a run."""


def given_values(placed: NodeAt, known: Mapping[str, object]) -> dict[str, object]:
    """Return the parameters of a node by name; those that depend on unknown values are `UNKNOWN_PLACEHOLDER`."""
    values: dict[str, object] = {}
    for name, found in placed.given.items():
        values[name] = UNKNOWN_PLACEHOLDER
        if isinstance(found, Template) and all(
            known.get(used, UNKNOWN_PLACEHOLDER) != UNKNOWN_PLACEHOLDER for used in found.names
        ):
            try:
                values[name] = found.evaluate(known)
            except ExpressionError:
                continue  # reported by the type checks
    return values


def try_make_state(signature: StateSignature, given: Mapping[str, object]) -> State | None:
    """Return the state with these parameters; None if they are invalid, which another check reports."""
    values: dict[str, object] = {}
    for name, parameter in signature.parameters.items():
        value = given.get(name, UNKNOWN_PLACEHOLDER if parameter.required else parameter.default)
        try:
            known = name in given and value != UNKNOWN_PLACEHOLDER
            values[name] = msgspec.convert(value, cast("type[Any]", parameter.type)) if known else value
        except msgspec.ValidationError:
            return None
    names = _field_names(signature.state)
    try:
        return signature.state(**{names[name]: value for name, value in values.items()})
    except Exception:
        # A custom class may reject placeholders with any exception.
        return None


@cache
def _field_names(state: type[State]) -> Mapping[str, str]:
    """Field name by parameter name; cached, as reading type hints for every node would double the load time."""
    return {found.encode_name: found.name for found in msgspec.structs.fields(state)}

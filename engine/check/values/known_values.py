"""Values under `with` as far as they are known before a run: constants, and expressions over known values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from engine.check.analyzed_behavior import template
from engine.check.flow.key_reads import only_name
from engine.document.expression.expression import Template
from engine.errors import ExpressionError


@dataclass(frozen=True)
class UnknownValue:
    """A value known only in a run; `key` is its parameter or userdata key, if it is only a key."""

    key: str | None = None


def known_part(found: Template | ExpressionError, known: Mapping[str, object]) -> object:
    """Return a value as plain data, with `UnknownValue` for parts that depend on unknown names.

    Args:
        found: The compiled value.
        known: Parameters by name.
    """
    if isinstance(found, ExpressionError):
        return UnknownValue()
    if found.names <= known.keys():
        try:
            return found.evaluate(known)
        except ExpressionError:
            return UnknownValue()  # reported by the type checks, or at the latest by a run
    return _inside(found, known)


def _inside(found: Template, known: Mapping[str, object]) -> object:
    value = found.value
    if isinstance(value, dict):
        fields = cast("dict[str, object]", value).items()
        return {key: known_part(template(inner), known) for key, inner in fields}
    if isinstance(value, list):
        return [known_part(template(inner), known) for inner in cast("list[object]", value)]
    return UnknownValue(only_name(found))

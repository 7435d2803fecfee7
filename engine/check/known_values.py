"""Values under `with` as far as they are known before a run: constants, and expressions over what is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from engine.check.analyzed_behavior import template
from engine.check.flow.key_reads import only_name
from engine.document.expression import Template
from engine.errors import ExpressionError


@dataclass(frozen=True)
class UnknownValue:
    """What only a run knows; `key` is the parameter or userdata key that it is, where it is nothing but one."""

    key: str | None = None


def known_part(found: Template | ExpressionError, known: Mapping[str, object]) -> object:
    """Return a value as plain data, with `UnknownValue` where it depends on more than is known.

    Args:
        found: The value, compiled.
        known: Parameters by name.
    """
    if isinstance(found, ExpressionError):
        return UnknownValue()
    if found.names <= known.keys():
        try:
            return found.evaluate(known)
        except ExpressionError:
            return UnknownValue()  # told where kinds are compared, or at the latest by a run
    return _inside(found, known)


def _inside(found: Template, known: Mapping[str, object]) -> object:
    value = found.value
    if isinstance(value, dict):
        fields = cast("dict[str, object]", value).items()
        return {key: known_part(template(inner), known) for key, inner in fields}
    if isinstance(value, list):
        return [known_part(template(inner), known) for inner in cast("list[object]", value)]
    return UnknownValue(only_name(found))

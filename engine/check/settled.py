"""Values under `with` as far as they are known before a run: constants, and expressions over what is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import cast

from engine.check.flow.read import only_name
from engine.check.subject import template
from engine.document.expression import Template
from engine.errors import ExpressionError


@dataclass(frozen=True)
class Open:
    """What only a run knows; `key` is the parameter or userdata key that it is, where it is nothing but one."""

    key: str | None = None


def settled(found: Template | ExpressionError, known: Mapping[str, object]) -> object:
    """Return a value as plain data, with `Open` where it depends on more than is known.

    Args:
        found: The value, compiled.
        known: Parameters by name.
    """
    if isinstance(found, ExpressionError):
        return Open()
    if found.names <= known.keys():
        try:
            return found.evaluate(known)
        except ExpressionError:
            return Open()  # told where kinds are compared, or at the latest by a run
    return _inside(found, known)


def _inside(found: Template, known: Mapping[str, object]) -> object:
    value = found.value
    if isinstance(value, dict):
        fields = cast("dict[str, object]", value).items()
        return {key: settled(template(inner), known) for key, inner in fields}
    if isinstance(value, list):
        return [settled(template(inner), known) for inner in cast("list[object]", value)]
    return Open(only_name(found))

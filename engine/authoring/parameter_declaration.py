"""Declares the parameters of a behavior, typed by Python types."""

from __future__ import annotations

import typing
from collections.abc import Mapping, Sequence
from typing import TypeVar

from msgspec import UNSET, UnsetType

from engine.authoring.expression_values import Param
from engine.authoring.plain_data import to_plain_data
from engine.authoring.source_location import calling_position
from engine.errors import DocumentError
from engine.messages import Pose

# Exactly one of these types: otherwise a default of another type would widen `T`.
T = TypeVar("T", bool, int, float, str, Pose, tuple[float, ...], list[object], dict[str, object])

_TYPES: Mapping[object, str] = {
    float: "number",
    int: "integer",
    str: "string",
    bool: "boolean",
    Pose: "pose",
    tuple: "joints",
    list: "list",
    dict: "mapping",
}


def parameter(
    name: str,
    kind: type[T],
    *,
    default: T | UnsetType = UNSET,
    minimum: float | None = None,
    maximum: float | None = None,
    unit: str = "",
    choices: Sequence[T] | None = None,
    label: str = "",
    description: str = "",
) -> Param[T]:
    """Declare a parameter of a run; without a default each run must set it.

    Args:
        name: Name in documents and in `-p name=value`.
        kind: `float`, `int`, `str`, `bool`, `Pose`, `tuple[float, ...]` for joint angles, `list` or `dict`.
        default: Value for runs that set none.
        minimum: Smallest number allowed.
        maximum: Largest number allowed.
        unit: SI unit, shown after the value.
        choices: Allowed values; by default any.
        label: Label in the form; the name if empty.
        description: Purpose of the parameter.

    Raises:
        DocumentError: the type is not supported, or the default cannot be written in a document.
    """
    place = calling_position()
    written = _TYPES.get(typing.get_origin(kind) or kind)
    if written is None:
        known = ", ".join(getattr(option, "__name__", str(option)) for option in _TYPES)
        raise DocumentError(f"a parameter cannot be a {kind}", where=place, hint=f"use one of {known}")
    given = {"minimum": minimum, "maximum": maximum, "unit": unit, "label": label, "description": description}
    keys: dict[str, object] = {"type": written, **{key: value for key, value in given.items() if value is not None}}
    keys["choices"] = to_plain_data(choices or (), what=f"parameter `{name}`", where=place)
    if default is not UNSET:
        keys["default"] = to_plain_data(default, what=f"parameter `{name}`", where=place)
    return Param(name=name, keys=keys, place=place)

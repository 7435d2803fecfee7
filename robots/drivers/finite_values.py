"""Whether all numbers of a reading are finite, whatever it is made of."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from typing import cast


def non_finite_value(value: object, name: str = "the reading") -> str:
    """Return which number in a value, or in the dataclasses and tuples in it, is not finite; empty if all are."""
    if isinstance(value, float):
        return "" if math.isfinite(value) else f"{name} is {value}"
    parts: Iterable[tuple[str, object]] = ()
    if is_dataclass(value):
        parts = ((field.name, getattr(value, field.name)) for field in fields(value))
    elif isinstance(value, tuple | list):
        items = cast("Iterable[object]", value)
        parts = ((f"{name}[{index}]", item) for index, item in enumerate(items))
    return next(filter(None, (non_finite_value(part, part_name) for part_name, part in parts)), "")

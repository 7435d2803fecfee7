"""Whether what came over a topic is a row of numbers: publishers in this process are not checked by the bus."""

from __future__ import annotations

from typing import cast


def are_numbers(values: object) -> bool:
    """Return whether `values` is a tuple of numbers, finite or not."""
    if not isinstance(values, tuple):
        return False
    row = cast("tuple[object, ...]", values)
    return all(isinstance(value, int | float) for value in row)

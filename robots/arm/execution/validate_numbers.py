"""Validates numbers received over a topic: the bus does not check publishers in this process."""

from __future__ import annotations

from typing import cast


def are_numbers(values: object) -> bool:
    """Return whether `values` is a tuple of numbers, finite or not."""
    if not isinstance(values, tuple):
        return False
    row = cast("tuple[object, ...]", values)
    return all(isinstance(value, int | float) for value in row)

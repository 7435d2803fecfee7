"""Counts as documents and expressions give them."""

from __future__ import annotations

import math


def whole_number(value: object) -> int | None:
    """Return a count of 0 or more, also one written as 1e6; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
        return None
    return int(value) if int(value) == value else None

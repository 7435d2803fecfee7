"""Counts in documents and expressions."""

from __future__ import annotations

import math


def whole_number(value: object) -> int | None:
    """Return an integer of 0 or more, also if written as 1e6; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < math.inf:
        return None
    return int(value) if int(value) == value else None

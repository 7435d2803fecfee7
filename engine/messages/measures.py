"""Measures of a run: numbers that are summed up while it goes, each with a name, a unit and a reduction.

The name of a measure is `OWNER.QUANTITY_UNIT`, with `_max` or `_min` before the unit where only the largest or least
value is kept: `left.path_m`, `left.force_max_n`, `left.gripper.slip_max_m`, `cell.contacts`. Its owner is the run
(`run`), a device by its address with dots (`left`, `left.gripper`), or the world (`cell`).
"""

from __future__ import annotations

from typing import Literal

import msgspec

Reduction = Literal["sum", "largest", "least"]


class Measure(msgspec.Struct, frozen=True, kw_only=True):
    """One measure: what it is of, and how its values during a run become one number."""

    name: str
    """With its owner; ends with its unit, or has none where it is a count."""
    unit: str
    """As written in reports: `m`, `rad`, `m/s`, `N`, `N m`, `s`; empty for a count."""
    reduction: Reduction

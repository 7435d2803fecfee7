"""What a snapshot tells of the bonds of a world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from engine.document import BondSpec
from robots.port import Array

BROKEN_BY: tuple[Literal["", "force", "torque", "cut"], ...] = ("", "force", "torque", "cut")
"""What has parted a bond, by its number; nothing while it is joined."""
BOND_FIELDS = 3
"""Numbers of a bond in a snapshot: what has parted it, then the force in N and the torque in N m that it carries."""


@dataclass(frozen=True, kw_only=True)
class BondReading:
    """One bond: what has parted it, empty while it is joined, and what it carried in the last step."""

    broken_by: Literal["", "force", "torque", "cut"]
    force_n: float
    torque_nm: float


def bond_readings(values: Array, names: tuple[str, ...]) -> dict[str, BondReading]:
    """Return the readings of all bonds from their numbers in a snapshot."""
    rows = values.reshape(-1, BOND_FIELDS).tolist()
    return {
        name: BondReading(broken_by=BROKEN_BY[int(broken)], force_n=force_n, torque_nm=torque_nm)
        for name, (broken, force_n, torque_nm) in zip(names, rows, strict=True)
    }


def joined_bodies(bonds: Mapping[str, BondSpec], readings: Mapping[str, BondReading]) -> dict[str, tuple[str, ...]]:
    """Return to what each body is joined by a bond; bodies that are joined to nothing are not listed."""
    found: dict[str, set[str]] = {}
    for name, bond in bonds.items():
        if not readings[name].broken_by:
            found.setdefault(bond.part, set()).add(bond.to)
            found.setdefault(bond.to, set()).add(bond.part)
    return {name: tuple(sorted(others)) for name, others in sorted(found.items())}

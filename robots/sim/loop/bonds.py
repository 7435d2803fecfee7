"""The bonds of a simulation: what breaks is decided by the forces that they carry, and by blades that press on them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

import numpy as np

from engine.document import BondSpec
from robots.port import Array
from robots.sim.loop.bond_reading import BOND_FIELDS, BROKEN_BY
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics

# A limit is exceeded for so long, in seconds, before a bond breaks: the solver needs some steps after a blow.
_SUSTAINED_S = 0.005
# A blade is at the place of a bond within so much of it.
_AT_PLACE_M = 0.003

_JOINED, _FORCE, _TORQUE, _CUT = range(len(BROKEN_BY))


@dataclass(kw_only=True)
class _Bond:
    """One bond; `broken` is the number in `BROKEN_BY`, `steps` for how many steps each kind of limit is exceeded."""

    spec: BondSpec
    number: int
    part: int
    other: int
    blades: tuple[int, ...]
    """The geometries of the blades that may cut it."""
    away: bool = False
    broken: int = _JOINED
    load: tuple[float, float] = (0.0, 0.0)
    steps: list[int] = field(default_factory=lambda: [0] * len(BROKEN_BY))

    @property
    def holds(self) -> bool:
        return not self.broken and not self.away


class Bonds:
    """Owned by the simulation; call `step` after the physics of a step.

    In an image each bond has one number, of what has broken it, 0 while it is joined.
    """

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        self._sustained = max(1, round(_SUSTAINED_S / physics.step_s))
        blades = {fixture.name: fixture.axis.cuts for fixture in cell.scene.fixtures if fixture.axis is not None}
        geoms = {name: physics.geom_body.index(physics.body_number(name)) for name, cuts in blades.items() if cuts}
        self._bonds = [
            _Bond(
                spec=bond,
                number=physics.coupling_number(name),
                part=physics.body_number(bond.part),
                other=physics.body_number(bond.to),
                blades=tuple(geom for blade, geom in geoms.items() if bond.kind in blades[blade]),
            )
            for name, bond in cell.scene.bonds.items()
        ]
        self._numbers = tuple(bond.number for bond in self._bonds)
        self._has_blades = any(bond.blades for bond in self._bonds)
        self.image_size = len(self._bonds)

    def step(self) -> None:
        """Measure the loads of the last step, and part what has carried too much, or is cut."""
        if not self._bonds:
            return
        touching = set(self._physics.contact_geoms().reshape(-1).tolist()) if self._has_blades else set[int]()
        for bond, load in zip(self._bonds, self._physics.coupling_loads(self._numbers), strict=True):
            if not bond.holds:
                continue
            bond.load = force_n, torque_nm = load
            spec = bond.spec
            exceeded = (
                False,
                spec.force_n is not None and force_n > spec.force_n,
                spec.torque_nm is not None and torque_nm > spec.torque_nm,
                spec.cut_n is not None and self._blade_force_n(bond, touching) > spec.cut_n,
            )
            bond.steps = [count + 1 if beyond else 0 for count, beyond in zip(bond.steps, exceeded, strict=True)]
            longest = max(bond.steps)
            if longest >= self._sustained:
                self._set(bond, broken=bond.steps.index(longest))

    def keep_apart(self, away: Collection[str]) -> None:
        """Let no bond act on parts that are far away with their module, each at a place of its own."""
        for bond in self._bonds:
            bond.away = bond.spec.part in away or bond.spec.to in away
            self._set(bond, broken=bond.broken)

    def joined_to(self, bodies: Collection[int]) -> set[int]:
        """Return the bodies that are joined to any of these."""
        found: set[int] = set()
        for bond in self._bonds:
            if bond.holds and (bond.part in bodies or bond.other in bodies):
                found |= {bond.part, bond.other}
        return found.difference(bodies)

    def reset(self) -> None:
        """Join everything as at the start."""
        for bond in self._bonds:
            self._set(bond, broken=_JOINED)

    def write_image(self, image: Array) -> None:
        """Write what is broken, (`image_size`,)."""
        image[:] = [bond.broken for bond in self._bonds]

    def take_over(self, image: Array, *, away: Collection[str]) -> None:
        """Continue from an image; the constraints are those of the physics, which was restored before."""
        for bond, broken in zip(self._bonds, image.tolist(), strict=True):
            bond.broken = int(broken)
        self.keep_apart(away)

    def write_report(self, values: Array) -> None:
        """Write the state and the load of each bond, as in `bond_reading`."""
        rows = values.reshape(-1, BOND_FIELDS)
        for row, bond in zip(rows, self._bonds, strict=True):
            row[:] = (bond.broken, *bond.load)

    def _set(self, bond: _Bond, *, broken: int) -> None:
        bond.broken, bond.steps, bond.load = broken, [0] * len(BROKEN_BY), (0.0, 0.0)
        self._physics.couple(bond.number, on=bond.holds)

    def _blade_force_n(self, bond: _Bond, touching: Collection[int]) -> float:
        """Return the force of a blade at the place of a bond on the two bodies that it joins, the greatest of all."""
        blades = [geom for geom in bond.blades if geom in touching]
        if not blades:
            return 0.0
        place = self._physics.point_of(bond.part, np.array(bond.spec.at_m))
        near = [geom for geom in blades if self._physics.gap_m(geom, place) <= _AT_PLACE_M]
        return max((self._pressing_n(geom, bond) for geom in near), default=0.0)

    def _pressing_n(self, blade: int, bond: _Bond) -> float:
        body_of, total_n = self._physics.geom_body, 0.0
        for index, (first, second) in enumerate(self._physics.contact_geoms().tolist()):
            if blade in (first, second) and body_of[second if first == blade else first] in (bond.part, bond.other):
                total_n += self._physics.normal_force_n(index)
        return total_n

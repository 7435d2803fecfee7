"""Contacts between bodies of a world, and their forces."""

from __future__ import annotations

from dataclasses import dataclass

from robots.port import Array
from robots.sim.physics.cell_model import ArmIndices, CellModel
from robots.sim.physics.physics import Physics

_NOTHING = -1


@dataclass(frozen=True, kw_only=True)
class PadContact:
    """Contact of one pad: the body pressed hardest (-1 for none), and the force along the closing direction."""

    body: int = _NOTHING
    force_n: float = 0.0


class ContactReader:
    """Reads the contacts of the last step."""

    def __init__(self, cell: CellModel, physics: Physics) -> None:
        self._physics = physics
        self._names = cell.body_names
        self._parts = frozenset(cell.parts)
        self._geom_body = physics.geom_body
        # Bodies that belong to no robot and are no free part are static.
        self._movable = frozenset(i for i, name in enumerate(cell.body_names) if name in self._parts or "/" in name)

    def pads(self, pad_geoms: tuple[int, int], *, axis: Array | None = None) -> tuple[PadContact, PadContact]:
        """Return the contacts of the two pads; the fingers of the same hand are excluded.

        `axis` is the closing direction in the world, the y axis of each pad by default.
        """
        left, right = pad_geoms
        pairs = self._physics.contact_pairs()
        if not pairs:
            return PadContact(), PadContact()
        own = (self._geom_body[left], self._geom_body[right])
        return self._pad(left, own, pairs, axis), self._pad(right, own, pairs, axis)

    def touched(
        self, places: tuple[frozenset[int], ...], *, own: frozenset[int], fixed: bool = False
    ) -> tuple[int, ...]:
        """Return for each place, a set of bodies, the body that it presses hardest, -1 for none.

        The bodies in `own` are excluded, as are fixtures unless `fixed`.
        """
        forces: list[dict[int, float]] = [{} for _ in places]
        for index, (a, b) in enumerate(self._physics.contact_pairs()):
            body_a, body_b = self._geom_body[a], self._geom_body[b]
            for mine, other in ((body_a, body_b), (body_b, body_a)):
                if mine not in own or other in own or not (fixed or other in self._movable):
                    continue
                force_n = self._physics.normal_force_n(index)
                for place, found in zip(places, forces, strict=True):
                    if mine in place:
                        found[other] = found.get(other, 0.0) + force_n
        return tuple(max(found, key=lambda body: found[body]) if found else _NOTHING for found in forces)

    def _pad(self, pad: int, own: tuple[int, int], pairs: list[tuple[int, int]], axis: Array | None) -> PadContact:
        forces: dict[int, float] = {}
        # A tilted part presses by normal and friction force together.
        closing = self._physics.geom_axes(pad)[:, 1] if axis is None else axis
        for index, (a, b) in enumerate(pairs):
            if pad not in (a, b):
                continue
            other = self._geom_body[b if a == pad else a]
            if other not in own:
                forces[other] = forces.get(other, 0.0) + self._physics.pressing_force_n(index, closing)
        if not forces:
            return PadContact()
        return PadContact(body=max(forces, key=lambda body: forces[body]), force_n=sum(forces.values()))

    def describe(self, arm: ArmIndices) -> str:
        """Describe what the arm touches, empty for nothing: `left hand touches part hca_north`."""
        touched: dict[str, float] = {}
        for index, (a, b) in enumerate(self._physics.contact_pairs()):
            body_a, body_b = self._geom_body[a], self._geom_body[b]
            if (body_a in arm.bodies) == (body_b in arm.bodies):
                continue
            mine, other = (body_a, body_b) if body_a in arm.bodies else (body_b, body_a)
            words = f"{self._member(arm, mine)} touches {self._other(other)}"
            touched[words] = touched.get(words, 0.0) + self._physics.normal_force_n(index)
        hardest = sorted(touched, key=lambda words: -touched[words])
        return " and ".join(hardest[:3])

    def _member(self, arm: ArmIndices, body: int) -> str:
        link = self._names[body].removeprefix(f"{arm.name}/")
        return f"{arm.name} {link.removeprefix(f'{arm.model.name}_')}"

    def _other(self, body: int) -> str:
        name = self._names[body]
        if name in self._parts:
            return f"part {name}"
        return name.replace("/", " ") if "/" in name else f"fixture {name}"

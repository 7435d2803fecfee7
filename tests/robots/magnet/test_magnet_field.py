"""The field of a magnet across a gap: the force falls with the square of the field, and ends at its reach."""

from __future__ import annotations

from typing import cast

import numpy as np
import pytest

from robots.magnet.magnet_body import MagnetIndices
from robots.magnet.magnet_mechanics import MagnetMechanics
from robots.magnet.magnet_model import MagnetModel
from robots.model.registry import robot_model
from robots.port import Array
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics

MAGNET, PLATE = 1, 2
MODEL = robot_model("irb4600", gripper="magnet").tool
DOWN = np.diag((1.0, -1.0, -1.0))


class FlatPlate:
    """Stands in for the physics: a face that looks down, and a plate below it, as far as an edge along x.

    Args:
        gap_m: The gap between face and plate.
        edge_m: Where the plate ends.
    """

    geom_body = (0, MAGNET, PLATE)

    def __init__(self, gap_m: float, *, edge_m: float = 1.0) -> None:
        self._top_m = -MODEL_FACE_M / 2 - gap_m
        self._edge_m = edge_m
        self.forces: dict[int, Array] = {}

    def geom_position(self, geom: int) -> Array:
        """The face is at the origin."""
        return np.zeros(3)

    def geom_axes(self, geom: int) -> Array:
        """Its z axis points down."""
        return DOWN

    def geom_distance(self, geom: int, point: Array) -> float:
        """The plate may be near."""
        return 0.0

    def ray(self, geom: int, start: Array, direction: Array) -> float:
        """Meet the plate."""
        return float((self._top_m - start[2]) / direction[2]) if start[0] < self._edge_m else -1.0

    def attract(self, body: int, *, force: Array, point: Array) -> None:
        """Remember a force."""
        self.forces[body] = force

    def speed(self, body: int) -> float:
        """The plate rests."""
        return 0.0


class Touching:
    """Stands in for the contacts: the face touches the plate."""

    def touched(self, places: object, **options: object) -> tuple[int, ...]:
        """Return the plate."""
        return (PLATE,)


def _model() -> MagnetModel:
    assert MODEL is not None
    return MODEL.mechanism_as(MagnetModel)


MODEL_FACE_M = _model().face.size_m[2]


def magnet(plate: FlatPlate) -> MagnetMechanics:
    """Switch a magnet over a plate on."""
    nothing = np.zeros(0)
    indices = MagnetIndices(
        model=_model(), qpos=nothing.astype(np.intp), body=MAGNET, face=MAGNET, ferrous=(PLATE,), home=nothing
    )
    own = frozenset((MAGNET,))
    made = MagnetMechanics(indices, cast("Physics", plate), cast("ContactReader", Touching()), own=own)
    made.take_over((1.0, 1.0))
    return made


@pytest.mark.parametrize(
    ("gap", "share"),
    [(0.0, 1.0), (1 / 3, 1 / 4), (2 / 3, 1 / 9), (0.99, 1 / (1 + 3 * 0.99) ** 2), (1.01, 0.0), (-0.5, 1.0)],
)
def test_a_gap_of_a_third_of_the_reach_halves_the_field_and_leaves_a_quarter_of_the_force(
    gap: float, share: float
) -> None:
    """A part that has sunk in a little is pulled as one that touches."""
    pull_n = magnet(FlatPlate(gap * _model().reach_m)).measured()[2]
    assert pull_n == pytest.approx(share * _model().max_force_n, rel=1e-6, abs=1e-9)


def test_a_plate_under_half_of_the_face_is_pulled_with_half_of_the_force() -> None:
    """The points in the middle count for the side that they are on."""
    pull_n = magnet(FlatPlate(0.0, edge_m=-1e-6)).measured()[2]
    assert 0.35 < pull_n / _model().max_force_n < 0.5


def test_plate_and_magnet_pull_at_each_other_with_the_same_force() -> None:
    plate = FlatPlate(0.0)
    magnet(plate).step(0.001)
    assert plate.forces[PLATE] == pytest.approx(-plate.forces[MAGNET])
    assert plate.forces[PLATE][2] == pytest.approx(_model().max_force_n)

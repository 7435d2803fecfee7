"""The drawn plant: within the bounds of its preset, by seed and name, and nothing at all for `ideal`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from engine.document import RealismName
from robots.port import Array
from robots.scene.realism import realism
from robots.sim.physics.cell_model import CellModel, build_cell
from robots.sim.physics.fingerprint import fingerprint
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import LEFT, PANDA, box, one_arm, two_arms

REALISTIC = pytest.mark.parametrize("name", ["typical", "poor"])
EFFORT_NM = np.array(PANDA.limits.effort_nm)


@pytest.fixture(scope="module", name="ideal")
def _ideal() -> CellModel:
    return build_cell(realistic(one_arm(box("part")), "ideal"))


def links(cell: CellModel, arm: str = "left") -> list[int]:
    """Return the bodies of an arm and its tool that have a mass."""
    model: Any = cell.model
    bodies = next(found.bodies for found in cell.arms if found.name == arm)
    return [body for body in sorted(bodies) if model.body_mass[body] > 1e-6]


def test_an_ideal_world_is_the_same_for_every_seed(ideal: CellModel) -> None:
    again = build_cell(realistic(one_arm(box("part")), "ideal", seed=5))
    assert fingerprint(again.model) == fingerprint(ideal.model)


@REALISTIC
def test_every_link_differs_from_its_nominal_mass_and_centre_within_the_bounds(
    ideal: CellModel, name: RealismName
) -> None:
    preset, cell = realism(name), build_cell(realistic(one_arm(box("part")), name))
    of, nominal, bodies = cell.model, ideal.model, links(ideal)
    assert links(cell) == bodies
    share = of.body_mass[bodies] / nominal.body_mass[bodies] - 1.0
    moved_m = of.body_ipos[bodies] - nominal.body_ipos[bodies]
    assert len(bodies) >= 10
    assert (np.abs(share) <= preset.link_mass_spread).all()
    assert np.abs(share).max() > 0.5 * preset.link_mass_spread
    assert (np.abs(moved_m) <= preset.link_com_m + 1e-12).all()
    assert np.abs(moved_m).max() > 0.5 * preset.link_com_m
    assert len(set(share.tolist())) == len(bodies)


@REALISTIC
def test_joints_have_friction_and_other_motors_within_the_bounds(ideal: CellModel, name: RealismName) -> None:
    preset, cell = realism(name), build_cell(realistic(one_arm(box("part")), name))
    dof = cell.arms[0].dof
    coulomb = cell.model.dof_frictionloss[dof] / (preset.coulomb_share * EFFORT_NM)
    # MuJoCo keeps a damper as polynomial; the nominal URDF has one of 0.003 N m s/rad.
    added = cell.model.dof_damping.reshape(len(cell.model.dof_frictionloss), -1)[dof, 0] - 0.003
    viscous = added / (preset.viscous_share_s_rad * EFFORT_NM)
    motors = cell.model.dof_armature[dof] / ideal.model.dof_armature[dof] - 1.0
    for found in (coulomb, viscous):
        assert (np.abs(found - 1.0) <= preset.friction_spread + 1e-9).all()
        assert np.ptp(found) > 0.2 * preset.friction_spread
    assert (np.abs(motors) <= preset.motor_inertia_spread).all()
    assert np.ptp(motors) > 0.2 * preset.motor_inertia_spread
    assert ideal.model.dof_frictionloss[dof].tolist() == [0.0] * PANDA.dof


@REALISTIC
def test_the_base_stands_beside_its_nominal_place_and_the_part_has_another_mass(
    ideal: CellModel, name: RealismName
) -> None:
    preset, cell = realism(name), build_cell(realistic(one_arm(box("part")), name))

    def base(of: CellModel) -> tuple[Array, Array]:
        root: Any = of.model.body(f"left/{PANDA.base_link}")
        return np.array(root.pos), np.array(root.quat)

    (place, turn), (nominal, upright) = base(cell), base(ideal)
    assert 0.0 < np.abs(place - nominal).max() <= preset.base_m
    angle_rad = 2.0 * np.arccos(min(1.0, abs(float(turn @ upright))))
    assert 1e-5 < angle_rad <= preset.base_rad * 3.0**0.5
    share = float(cell.model.body("part").mass[0] / ideal.model.body("part").mass[0]) - 1.0
    assert 0.0 < abs(share) <= preset.payload_spread


def test_a_seed_draws_the_same_plant_again_and_another_seed_another_one() -> None:
    one, again, other = (build_cell(realistic(one_arm(), seed=seed)) for seed in (3, 3, 4))
    assert fingerprint(one.model) == fingerprint(again.model)
    assert fingerprint(one.model) != fingerprint(other.model)


def test_another_arm_in_the_cell_changes_no_draw() -> None:
    alone, beside = build_cell(realistic(one_arm())), build_cell(realistic(two_arms()))
    assert alone.model.body_mass[links(alone)].tolist() == beside.model.body_mass[links(beside)].tolist()
    left, right = links(beside), links(beside, "right")
    assert beside.model.body_mass[left].tolist() != beside.model.body_mass[right].tolist()
    assert beside.scene.arms[0] == LEFT

"""A typical arm measures its friction and what hangs on its tool, within the uncertainties that it gives."""

from __future__ import annotations

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.document import load_cell
from engine.skills.arm_control import SetLoad
from engine.skills.identification import FrictionEstimate, IdentifyFriction, IdentifyPayload, PayloadEstimate
from engine.skills.simulated_world import PushBody
from robots.scene.scene_builder import build_scene
from robots.sim.physics.cell_model import build_cell
from tests.robots.arm.simulated import CELL, simulated

MEASURED = ("panda_joint2", "panda_joint6")


@pytest.mark.virtual
async def test_the_friction_of_joints_is_measured_within_its_uncertainty() -> None:
    """The truth is what the simulator drew for the seed: Coulomb within 10 %, viscous within its uncertainty."""
    cell = build_cell(build_scene(load_cell(CELL).document))
    async with simulated() as opened:
        end = await opened.perform(IdentifyFriction(joints=MEASURED))
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    found = end.result
    assert isinstance(found, FrictionEstimate)
    assert tuple(joint.joint for joint in found.joints) == MEASURED
    for joint in found.joints:
        dof = cell.arms[0].dof[cell.arms[0].model.arm_joints.index(joint.joint)]
        coulomb_nm, viscous = float(cell.model.dof_frictionloss[dof]), float(cell.model.dof_damping[dof])
        assert coulomb_nm > 0.05
        assert joint.coulomb_nm == pytest.approx(coulomb_nm, rel=0.1)
        assert abs(joint.coulomb_nm - coulomb_nm) < joint.coulomb_uncertainty_nm
        assert abs(joint.viscous_nms_rad - viscous) < joint.viscous_uncertainty_nms_rad
        assert joint.coulomb_uncertainty_nm < 0.3 * coulomb_nm


@pytest.mark.virtual
@pytest.mark.parametrize("set_kg", [0.0, 1.0])
async def test_what_hangs_on_the_tool_is_weighed_whatever_load_is_set(set_kg: float) -> None:
    """1.5 kg at a point of the hand; the sensor's offset of up to 0.2 N is told from it.

    It hangs there as a force, which has no inertia: 2 % of it are missing. Parts with inertia are weighed in
    `tests/behaviors/identification`.
    """
    mass_kg = 1.5
    async with simulated() as opened:
        if set_kg:
            await opened.bus.call(SetLoad(mass_kg=set_kg, com_m=(0.0, 0.0, -0.05)), to="left")
        weight = PushBody(
            body="left/panda_hand_tcp",
            force_n=(0.0, 0.0, -9.81 * mass_kg),
            duration_s=60.0,
            at_m=(0.03, 0.0, 0.02),
        )
        await opened.bus.call(weight, to="cell")
        await opened.bus.clock.sleep(0.5)
        end = await opened.perform(IdentifyPayload())
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    found = end.result
    assert isinstance(found, PayloadEstimate)
    assert found.mass_kg == pytest.approx(mass_kg, abs=0.04)
    assert found.mass_uncertainty_kg < 0.1
    assert np.abs(np.array(found.com_m) - (0.03, 0.0, 0.02)).max() < 0.005
    assert found.residual_n < 0.5


@pytest.mark.virtual
async def test_an_unknown_joint_is_refused_with_those_that_there_are() -> None:
    async with simulated() as opened:
        end = await opened.perform(IdentifyFriction(joints=("elbow",)))
    assert end.status is GoalStatus.REJECTED
    assert end.cause is not None
    assert "the arm has no joint elbow" in end.cause.message

"""A load that is set no longer pulls the arm down, nor counts as a push; one that is not set is named."""

from __future__ import annotations

import asyncio
import re

import numpy as np
import pytest

from engine.messages import Vector3
from engine.skills.arm_control import ControllerName, ControlSettings
from robots.port import MotionEnd, Tolerance
from robots.scene.sim_scene import SimScene
from robots.sim.physics.cell_model import CellModel, build_cell
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import LIFTED, box, grasp, move, one_arm, opened, smooth
from tests.robots.sim.stepped import SteppedArm

WEIGHT_N = (0.0, 0.0, -2.0 * 9.81)
HEAVY: SimScene = one_arm(box("part", mass_kg=2.0))


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(realistic(one_arm(), "ideal"))


def sag_m(cell: CellModel, settings: ControlSettings, at_m: Vector3) -> float:
    """Return how far the tool is below its set point with 2 kg at a point of the tool link."""
    arm = SteppedArm(cell, settings)
    before = arm.tool_xyz
    arm.push(WEIGHT_N, 3.0, at_m=at_m)
    arm.run(2.5)
    return float((before - arm.tool_xyz)[2])


@pytest.mark.parametrize("controller", ["joint_impedance", "cartesian_impedance"])
@pytest.mark.parametrize("at_m", [(0.0, 0.0, 0.0), (0.03, -0.02, 0.05)])
def test_two_kilograms_sag_by_millimetres_unless_the_arm_knows_of_them(
    cell: CellModel, controller: ControllerName, at_m: Vector3
) -> None:
    assert sag_m(cell, ControlSettings(controller=controller), at_m) > 0.004
    assert abs(sag_m(cell, ControlSettings(controller=controller, load_kg=2.0, load_com_m=at_m), at_m)) < 1e-5


def test_a_known_load_is_not_felt(cell: CellModel) -> None:
    arm = SteppedArm(cell, ControlSettings(load_kg=2.0, load_com_m=(0.0, 0.0, 0.03)))
    arm.push(WEIGHT_N, 3.0, at_m=(0.0, 0.0, 0.03))
    arm.run(2.5)
    assert np.abs(arm.sample.wrench).max() < 1e-3
    assert np.abs(arm.sample.external_nm).max() < 1e-3


async def carry(world: SimWorld, settings: ControlSettings) -> tuple[float, float]:
    """Lift the heavy part; return how far the joints are off at rest, and the greatest force felt on a way."""
    arm = world.arm("left")
    await grasp(world, force_n=100.0)
    arm.configure(settings)
    assert (await move(arm, LIFTED)).end is MotionEnd.REACHED
    off = float(np.abs(arm.sample().position_rad - LIFTED).max())
    motion = arm.follow(smooth(LIFTED, LIFTED + np.array([0.5, 0, 0, 0, 0, 0, 0.0]), 1.0), tolerance=Tolerance())
    felt = 0.0
    while motion.progress < 1.0:
        await asyncio.sleep(0.01)
        felt = max(felt, float(np.linalg.norm(arm.sample().wrench[:3])))
    await motion.report()
    assert world.gripper("left").sample().contacts == ("part", "part")
    return off, felt


@pytest.mark.virtual
async def test_a_gripped_part_is_carried_as_if_it_weighed_nothing_once_its_mass_is_set() -> None:
    async with opened(HEAVY) as world:
        off, felt = await carry(world, ControlSettings())
    async with opened(HEAVY) as world:
        known_off, known_felt = await carry(world, ControlSettings(load_kg=2.0))
    assert (off > 0.005, felt > 18.0) == (True, True)
    assert (known_off < 0.001, known_felt < 3.0) == (True, True)


@pytest.mark.virtual
async def test_a_motion_that_fails_under_a_load_that_is_not_set_names_its_mass() -> None:
    async with opened(HEAVY) as world:
        arm = world.arm("left")
        await grasp(world, force_n=100.0)
        motion = arm.follow(
            smooth(arm.sample().desired_rad, LIFTED, 1.0), tolerance=Tolerance(goal_rad=0.002, settle_s=0.3)
        )
        report = await motion.report()
    assert report.end is MotionEnd.FAILED
    # Up to 3 % more or less, and the offset of the sensor.
    assert re.search(
        r"the tool is pulled down as by (1\.9|2\.0|2\.1) kg more than the load that is set \(motion\.SetLoad\)$",
        report.reason,
    )

"""The claw of the servo arm: a test cylinder is pulled out of its rack; a tube is lifted, held, put back."""

from __future__ import annotations

import asyncio
import math

import numpy as np
import pytest

from engine.messages import Pose
from robots.port import GripperSample, MotionEnd, MotionReport
from robots.port.grasp_check import GraspCommand, check_grasp
from robots.scene.sim_scene import FixtureBody, PartBody
from tests.robots.sim.tool_cell import ARM, Reach, block, reaching, scene, slip_while_held

# The elbow swings the claw down over what stands in front of the arm, where the base joint points.
BASE_RAD, UP_RAD, AT_RAD = 0.6, 0.3, -0.4
RADIUS_M = 0.225 * math.cos(AT_RAD)
X, Y = RADIUS_M * math.cos(BASE_RAD), RADIUS_M * math.sin(BASE_RAD)
TABLE = block("table", (0.3, 0.1, 0.0001), (0.4, 0.4))
RACK = FixtureBody(
    name="rack", shape="tray", size_m=(0.0212, 0.0212, 0.03), wall_m=0.005, pose=Pose(xyz=(X, Y, 0.0001))
)


def upright_tube(diameter_m: float, *, bottom_m: float, mass_kg: float) -> PartBody:
    pose = Pose(xyz=(X, Y, bottom_m + 0.1))
    return PartBody(name="tube", shape="cylinder", size_m=(diameter_m, 0.2), mass_kg=mass_kg, pose=pose)


TUBE = scene("servo_arm", "servo_claw", parts=(upright_tube(0.02, bottom_m=0.0001, mass_kg=0.02),), fixtures=(TABLE,))
TEST_CYLINDER = scene(
    "servo_arm", "servo_claw", parts=(upright_tube(0.01, bottom_m=0.0051, mass_kg=0.03),), fixtures=(TABLE, RACK)
)


async def swing(reach: Reach, elbow_rad: float) -> MotionReport:
    return await reach.joints(np.array([BASE_RAD, elbow_rad]))


async def close(reach: Reach, width_m: float = 0.0) -> MotionReport:
    return await reach.world.gripper(ARM).close_to(width_m=width_m, speed_m_s=0.05, force_n=3.0).report()


async def reach_for(reach: Reach) -> None:
    await swing(reach, UP_RAD)
    assert (await swing(reach, AT_RAD)).end is MotionEnd.REACHED


def gripped(reach: Reach) -> GripperSample:
    return reach.world.gripper(ARM).sample()


@pytest.mark.virtual
async def test_the_claw_is_open_at_the_start_and_comes_to_a_width() -> None:
    async with reaching(scene("servo_arm", "servo_claw")) as reach:
        assert gripped(reach).width_m == pytest.approx(0.084, abs=0.002)
        for width_m in (0.03, 0.084):
            assert (await close(reach, width_m)).end is MotionEnd.REACHED
            assert gripped(reach).width_m == pytest.approx(width_m, abs=0.001)


@pytest.mark.virtual
async def test_a_tube_is_lifted_held_and_put_back() -> None:
    async with reaching(TUBE) as reach:
        start, _ = reach.part("tube")
        await reach_for(reach)
        assert (await close(reach)).end is MotionEnd.REACHED
        assert gripped(reach).contacts == ("tube", "tube")
        assert gripped(reach).width_m == pytest.approx(0.02, abs=0.002)

        assert (await swing(reach, AT_RAD + 0.46)).end is MotionEnd.REACHED
        slip_m, _ = await slip_while_held(reach, "tube")
        assert slip_m < 0.005
        assert reach.part("tube")[0][2] > start[2] + 0.1

        assert (await swing(reach, AT_RAD)).end is MotionEnd.REACHED
        await close(reach, 0.084)
        await swing(reach, UP_RAD)
        await asyncio.sleep(0.5)
        xyz, turn = reach.part("tube")
        assert float(np.linalg.norm(xyz - start)) < 0.01
        assert turn.as_matrix()[2, 2] > 0.999


@pytest.mark.virtual
async def test_the_test_cylinder_is_pulled_out_of_its_rack_and_held() -> None:
    async with reaching(TEST_CYLINDER) as reach:
        start, _ = reach.part("tube")
        await reach_for(reach)
        await close(reach)
        assert check_grasp(gripped(reach), GraspCommand(least_m=0.008, most_m=0.012, force_n=3.0)) == ""
        await swing(reach, AT_RAD + 0.46)
        await asyncio.sleep(2.0)
        assert reach.part("tube")[0][2] > start[2] + 0.09
        assert gripped(reach).contacts == ("tube", "tube")


@pytest.mark.virtual
async def test_without_a_tube_the_claw_closes_on_nothing_and_the_check_says_so() -> None:
    async with reaching(scene("servo_arm", "servo_claw")) as reach:
        await swing(reach, AT_RAD)
        await close(reach)
        reason = check_grasp(gripped(reach), GraspCommand(least_m=0.008, most_m=0.012, force_n=3.0))
        assert "touch nothing" in reason


@pytest.mark.virtual
async def test_a_restored_claw_holds_on_to_its_tube() -> None:
    async with reaching(TUBE) as reach:
        await reach_for(reach)
        await close(reach)
        await swing(reach, AT_RAD + 0.46)
        before, snapshot = reach.part("tube")[0], reach.world.snapshot()
    async with reaching(TUBE) as reach:
        await reach.world.restore(snapshot)
        await asyncio.sleep(0.5)
        assert gripped(reach).contacts == ("tube", "tube")
        assert reach.strayed_m("tube", before) < 0.003

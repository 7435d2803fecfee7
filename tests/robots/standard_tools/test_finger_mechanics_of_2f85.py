"""A 2F-85 on a UR10: opening and force are those of the pads, parts are lifted, held, placed, missed, restored."""

from __future__ import annotations

import asyncio

import pytest

from engine.messages import Pose, Quaternion, Vector3
from robots.port import GripperSample, MotionEnd, MotionReport
from robots.port.grasp_check import GraspCommand, check_grasp
from robots.scene.sim_scene import PartBody, SimScene
from tests.robots.sim.tool_cell import ARM, Reach, block, reaching, scene, slip_while_held

TABLE = block("table", (0.8, 0.0, 0.1), (0.8, 0.8))
PART: Vector3 = (0.7, 0.1, 0.13)
# Pointing down, fingers along the world's x.
GRASP: Quaternion = (0.70710678, -0.70710678, 0.0, 0.0)


BESIDES_N = 1.5
"""What presses besides the drive: the weight of the fingers, since the drive does not know how the gripper is held, and
the friction of the part on the table, along which the finger that comes first pushes it."""


def cell(size_m: Vector3 = (0.06, 0.05, 0.06), *, mass_kg: float = 0.5) -> SimScene:
    """A box on a table."""
    pose = Pose(xyz=(PART[0], PART[1], 0.1 + size_m[2] / 2))
    return scene(
        "ur10",
        "robotiq_2f85",
        parts=(PartBody(name="part", shape="box", size_m=size_m, mass_kg=mass_kg, pose=pose),),
        fixtures=(TABLE,),
    )


async def close(reach: Reach, *, force_n: float, width_m: float = 0.0, speed_m_s: float = 0.1) -> MotionReport:
    gripper = reach.world.gripper(ARM)
    return await gripper.close_to(width_m=width_m, speed_m_s=speed_m_s, force_n=force_n).report()


async def reach_for(reach: Reach) -> None:
    assert (await reach.to((PART[0], PART[1], 0.3), GRASP, duration_s=1.5)).end is MotionEnd.REACHED
    assert (await reach.to(PART, GRASP)).end is MotionEnd.REACHED


async def lift(reach: Reach) -> MotionReport:
    return await reach.to((PART[0], PART[1], PART[2] + 0.11), GRASP)


def gripped(reach: Reach) -> GripperSample:
    return reach.world.gripper(ARM).sample()


@pytest.mark.virtual
async def test_the_fingers_come_to_every_width_within_a_tenth_of_a_millimetre_at_the_speed() -> None:
    async with reaching(scene("ur10", "robotiq_2f85")) as reach:
        for width_m in (0.06, 0.01, 0.045, 0.0, 0.085):
            way_m = abs(gripped(reach).width_m - width_m)
            start_s = reach.world.measured().time_s
            assert (await close(reach, force_n=60.0, width_m=width_m)).end is MotionEnd.REACHED
            assert gripped(reach).width_m == pytest.approx(width_m, abs=0.0001)
            assert reach.world.measured().time_s - start_s == pytest.approx(way_m / 0.1, abs=0.25)


@pytest.mark.virtual
async def test_a_part_is_lifted_held_without_slip_and_placed() -> None:
    async with reaching(cell()) as reach:
        start, _ = reach.part("part")
        await reach_for(reach)
        assert (await close(reach, force_n=60.0)).end is MotionEnd.REACHED
        sample = gripped(reach)
        assert sample.contacts == ("part", "part")
        assert sample.force_n == pytest.approx(60.0, abs=BESIDES_N)
        assert sample.width_m == pytest.approx(0.06, abs=0.0006)

        assert (await lift(reach)).end is MotionEnd.REACHED
        slip_m, turn_rad = await slip_while_held(reach, "part")
        assert slip_m < 0.0005
        assert turn_rad < 0.01
        assert reach.part("part")[0][2] > start[2] + 0.1

        await reach.to(PART, GRASP)
        assert (await close(reach, force_n=60.0, width_m=0.085)).end is MotionEnd.REACHED
        await lift(reach)
        assert reach.strayed_m("part", start) < 0.01
        assert gripped(reach).contacts == ("", "")


@pytest.mark.virtual
@pytest.mark.parametrize(("asked_n", "pressed_n"), [(5.0, 20.0), (150.0, 150.0), (900.0, 235.0)])
async def test_the_force_is_what_was_asked_for_within_the_grippers_range(asked_n: float, pressed_n: float) -> None:
    async with reaching(cell()) as reach:
        await reach_for(reach)
        await close(reach, force_n=asked_n)
        assert gripped(reach).force_n == pytest.approx(pressed_n, rel=0.02, abs=BESIDES_N)


@pytest.mark.virtual
async def test_without_a_part_the_fingers_close_on_nothing_and_the_check_says_so() -> None:
    async with reaching(scene("ur10", "robotiq_2f85", fixtures=(TABLE,))) as reach:
        await reach_for(reach)
        assert (await close(reach, force_n=60.0)).end is MotionEnd.REACHED
        reason = check_grasp(gripped(reach), GraspCommand(least_m=0.05, most_m=0.07, force_n=60.0))
        assert reason == "fingers closed to 0.0 mm and touch nothing"


@pytest.mark.virtual
async def test_a_heavy_part_held_too_weakly_slips_out_and_is_noticed() -> None:
    async with reaching(cell(mass_kg=6.0)) as reach:
        start, _ = reach.part("part")
        await reach_for(reach)
        await close(reach, force_n=20.0)
        grip = GraspCommand(least_m=0.05, most_m=0.07, force_n=20.0)
        assert check_grasp(gripped(reach), grip) == ""
        await lift(reach)
        await asyncio.sleep(1.0)
        assert reach.part("part")[0][2] < start[2] + 0.02
        assert check_grasp(gripped(reach), grip) != ""


@pytest.mark.virtual
async def test_a_part_wider_than_the_opening_stops_the_arm_in_words() -> None:
    async with reaching(cell((0.1, 0.1, 0.06), mass_kg=20.0)) as reach:
        await reach.to((PART[0], PART[1], 0.3), GRASP, duration_s=1.5)
        report = await reach.to(PART, GRASP)
        assert report.end is MotionEnd.FAILED
        assert "touches part part" in report.reason


@pytest.mark.virtual
async def test_a_restored_gripper_holds_on_to_its_part() -> None:
    async with reaching(cell()) as reach:
        await reach_for(reach)
        await close(reach, force_n=60.0)
        await lift(reach)
        before, snapshot = reach.part("part")[0], reach.world.snapshot()
    async with reaching(cell()) as reach:
        await reach.world.restore(snapshot)
        await asyncio.sleep(1.0)
        assert reach.strayed_m("part", before) < 0.001
        assert gripped(reach).force_n == pytest.approx(60.0, rel=0.04)

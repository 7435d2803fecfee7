"""A magnet on an IRB 4600: plates are pulled, carried, let go; others are left alone; too much weight tears off."""

from __future__ import annotations

import asyncio
from typing import cast

import pytest

from engine.messages import Pose, Vector3
from robots.magnet.magnet_grasp_check import check_magnet_grasp
from robots.magnet.magnet_port import MagnetSample
from robots.magnet.simulated_magnet_port import SimMagnetPort
from robots.port import MotionEnd
from robots.scene.sim_scene import PartBody, SimScene
from tests.robots.sim.tool_cell import ARM, Reach, block, reaching, scene, slip_while_held

PEDESTAL = block("pedestal", (1.4, 0.2, 0.5), (0.4, 0.4))
TOP_M = 0.51


def cell(*, mass_kg: float = 5.0, magnetic: bool = True, size_m: Vector3 = (0.3, 0.2, 0.01)) -> SimScene:
    """A plate on a pedestal, its top at `TOP_M`."""
    pose = Pose(xyz=(1.4, 0.2, 0.5 + size_m[2] / 2))
    plate = PartBody(name="plate", shape="box", size_m=size_m, mass_kg=mass_kg, magnetic=magnetic, pose=pose)
    return scene("irb4600", "magnet", parts=(plate,), fixtures=(PEDESTAL,))


async def come_near(reach: Reach, *, gap_m: float = 0.001, x_m: float = 1.4) -> None:
    assert (await reach.to((x_m, 0.2, TOP_M + 0.12), duration_s=1.5)).end is MotionEnd.REACHED
    assert (await reach.to((x_m, 0.2, TOP_M + gap_m))).end is MotionEnd.REACHED


def magnet_of(reach: Reach) -> SimMagnetPort:
    return cast("SimMagnetPort", reach.world.tool(ARM, "magnet"))


async def switch(reach: Reach, *, on: bool) -> None:
    report = await magnet_of(reach).switch(on=on).report()
    assert report.end is MotionEnd.REACHED


def measured(reach: Reach) -> MagnetSample:
    return magnet_of(reach).sample()


def why_not(reach: Reach) -> str:
    magnet = magnet_of(reach)
    return check_magnet_grasp(magnet.sample(), max_force_n=magnet.max_force_n)


@pytest.mark.virtual
async def test_a_plate_jumps_to_the_face_is_carried_and_placed() -> None:
    async with reaching(cell()) as reach:
        start, _ = reach.part("plate")
        await come_near(reach)
        await switch(reach, on=True)
        sample = measured(reach)
        assert (sample.on, sample.contact, why_not(reach)) == (True, "plate", "")
        assert sample.pull_n == pytest.approx(210.0, rel=0.01)

        assert (await reach.to((1.4, 0.2, TOP_M + 0.12))).end is MotionEnd.REACHED
        slip_m, turn_rad = await slip_while_held(reach, "plate")
        assert slip_m < 0.0005
        assert turn_rad < 0.002
        assert reach.part("plate")[0][2] > start[2] + 0.1

        await reach.to((1.4, 0.2, TOP_M + 0.001))
        await switch(reach, on=False)
        await reach.to((1.4, 0.2, TOP_M + 0.12))
        assert reach.strayed_m("plate", start) < 0.01
        assert (measured(reach).on, why_not(reach)) == (False, "the magnet is switched off")


@pytest.mark.virtual
async def test_a_plate_held_at_its_side_does_not_peel_off() -> None:
    async with reaching(cell()) as reach:
        await come_near(reach, x_m=1.43)
        await switch(reach, on=True)
        await reach.to((1.43, 0.2, TOP_M + 0.12))
        slip_m, turn_rad = await slip_while_held(reach, "plate")
        assert (slip_m < 0.001, turn_rad < 0.01, why_not(reach)) == (True, True, "")


@pytest.mark.virtual
async def test_a_plate_that_is_not_magnetic_is_touched_and_not_held() -> None:
    async with reaching(cell(magnetic=False)) as reach:
        start, _ = reach.part("plate")
        await come_near(reach, gap_m=-0.0015)
        await switch(reach, on=True)
        assert why_not(reach) == "the magnet touches plate and pulls at it with 0.0 N of 210 N"
        await reach.to((1.4, 0.2, TOP_M + 0.12))
        assert reach.strayed_m("plate", start) < 0.002


@pytest.mark.virtual
async def test_over_nothing_the_magnet_says_that_it_touches_nothing() -> None:
    async with reaching(scene("irb4600", "magnet", fixtures=(PEDESTAL,))) as reach:
        await come_near(reach)
        await switch(reach, on=True)
        assert why_not(reach) == "the magnet is on and touches nothing"


@pytest.mark.virtual
async def test_a_plate_out_of_reach_of_the_field_stays_where_it_is() -> None:
    async with reaching(cell(mass_kg=0.1)) as reach:
        start, _ = reach.part("plate")
        await come_near(reach, gap_m=0.006)
        await switch(reach, on=True)
        await asyncio.sleep(0.5)
        assert reach.strayed_m("plate", start) < 0.0005


@pytest.mark.virtual
async def test_a_plate_heavier_than_the_pull_stays_down() -> None:
    async with reaching(cell(mass_kg=25.0)) as reach:
        start, _ = reach.part("plate")
        await come_near(reach, gap_m=0.0)
        await switch(reach, on=True)
        await reach.to((1.4, 0.2, TOP_M + 0.12))
        assert reach.strayed_m("plate", start) < 0.005
        assert why_not(reach) == "the magnet is on and touches nothing"


@pytest.mark.virtual
async def test_a_plate_that_can_just_be_carried_slowly_tears_off_in_a_quick_motion() -> None:
    async with reaching(cell(mass_kg=17.0)) as reach:
        start, _ = reach.part("plate")
        await come_near(reach, gap_m=0.0)
        await switch(reach, on=True)
        await reach.to((1.4, 0.2, TOP_M + 0.1), duration_s=3.0)
        assert reach.part("plate")[0][2] > start[2] + 0.09
        assert why_not(reach) == ""
        await reach.to((1.4, 0.2, TOP_M + 0.5), duration_s=0.5)
        await asyncio.sleep(1.0)
        assert reach.part("plate")[0][2] < start[2] + 0.05
        assert why_not(reach) == "the magnet is on and touches nothing"


@pytest.mark.virtual
async def test_the_wrist_feels_the_weight_of_the_plate_and_nothing_of_the_field() -> None:
    async with reaching(cell()) as reach:
        await come_near(reach)
        await switch(reach, on=True)
        await reach.to((1.4, 0.2, TOP_M + 0.12))
        await asyncio.sleep(1.0)
        assert reach.port.sample().wrench[2] == pytest.approx(-5.0 * 9.81, abs=0.3)


@pytest.mark.virtual
async def test_a_cancelled_switch_leaves_the_plate_where_the_command_has_it() -> None:
    async with reaching(cell()) as reach:
        await come_near(reach)
        motion = magnet_of(reach).switch(on=True)
        await asyncio.sleep(0.05)
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert why_not(reach) == ""


@pytest.mark.virtual
async def test_a_restored_magnet_holds_on_to_its_plate() -> None:
    async with reaching(cell()) as reach:
        await come_near(reach)
        await switch(reach, on=True)
        await reach.to((1.4, 0.2, TOP_M + 0.12))
        before, snapshot = reach.part("plate")[0], reach.world.snapshot()
    async with reaching(cell()) as reach:
        await reach.world.restore(snapshot)
        assert why_not(reach) == ""
        await asyncio.sleep(1.0)
        assert reach.strayed_m("plate", before) < 0.001
        assert why_not(reach) == ""

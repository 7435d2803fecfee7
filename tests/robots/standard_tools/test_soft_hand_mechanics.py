"""A soft hand on a Panda: one motor, fingers that adapt; what is held at 70 % is not at 20 %."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.messages import Pose, Quaternion
from robots.port import Array, HandSample, MotionEnd, MotionReport
from robots.port.hand_grasp_check import HandGrasp, check_hand_grasp
from robots.scene.sim_scene import FixtureBody, PartBody, SimScene
from tests.robots.sim.tool_cell import ARM, Reach, block, reaching, scene, slip_while_held
from tests.tiers import nightly

# Fingers forward, palm to the left, thumb up; and a configuration in which the arm stands like that.
SIDE: Quaternion = (0.0, 0.70710678, 0.0, 0.70710678)
BESIDE = np.array([0.0, -0.6, -0.2, -2.4, -0.6, 3.4, -2.6])
PART_XYZ = np.array([0.5, 0.0, 0.66])

CYLINDER = PartBody(name="part", shape="cylinder", size_m=(0.05, 0.12), mass_kg=0.25, pose=Pose(xyz=(0.5, 0.0, 0.66)))
BOX = PartBody(name="part", shape="box", size_m=(0.05, 0.05, 0.1), mass_kg=0.2, pose=Pose(xyz=(0.5, 0.0, 0.66)))
SPHERE = PartBody(name="part", shape="sphere", size_m=(0.07,), mass_kg=0.2, pose=Pose(xyz=(0.5, 0.0, 0.66)))
PARTS = {"cylinder": CYLINDER, "box": BOX, "sphere": SPHERE}


# A ball of 70 mm on a hole of 16 mm has its middle 34.07 mm above the rim.
CUP = FixtureBody(
    name="cup",
    shape="tray",
    size_m=(0.024, 0.024, 0.01),
    wall_m=0.004,
    pose=Pose(xyz=(0.5, 0.0, 0.66 - 0.03407 - 0.01)),
)


def cell(part: PartBody) -> SimScene:
    """A part on a narrow pedestal, the ball in a cup."""
    if part.shape == "sphere":
        return scene("panda", "softhand", parts=(part,), fixtures=(CUP,))
    pedestal = block("pedestal", (0.5, 0.0, 0.66 - part.size_m[-1] / 2), (0.1, 0.1))
    return scene("panda", "softhand", parts=(part,), fixtures=(pedestal,))


def around(part: PartBody) -> Array:
    """Where the tool is when the part lies against palm and knuckles."""
    if part.shape == "sphere":
        return PART_XYZ - np.array([0.0, 0.013, 0.0])
    return PART_XYZ + np.array([0.009, -0.002, 0.0])


async def go(reach: Reach, xyz: Array, *, duration_s: float = 1.0) -> MotionReport:
    x, y, z = xyz.tolist()
    return await reach.to((x, y, z), SIDE, duration_s=duration_s)


async def close(reach: Reach, share: float, *, time_s: float = 1.5) -> MotionReport:
    return await reach.world.hand(ARM).close_to(share=share, time_s=time_s).report()


async def reach_for(reach: Reach, part: PartBody) -> None:
    x, y, z = (around(part) - np.array([0.0, 0.1, 0.0])).tolist()
    assert (await reach.to((x, y, z), SIDE, duration_s=1.5, like=BESIDE)).end is MotionEnd.REACHED
    assert (await go(reach, around(part))).end is MotionEnd.REACHED


def measured(reach: Reach) -> HandSample:
    return reach.world.hand(ARM).sample()


def held(reach: Reach) -> HandGrasp:
    hand = reach.world.hand(ARM)
    return check_hand_grasp(hand.sample(), max_force_n=hand.max_force_n)


@pytest.mark.virtual
@pytest.mark.parametrize("shape", ["sphere", nightly("box"), nightly("cylinder")])
async def test_a_part_is_lifted_and_held_at_seventy_percent(shape: str) -> None:
    part = PARTS[shape]
    async with reaching(cell(part)) as reach:
        await reach_for(reach, part)
        assert (await close(reach, 0.7)).end is MotionEnd.REACHED
        assert held(reach) == HandGrasp(part="part")
        low, _ = reach.part("part")
        await go(reach, around(part) + np.array([0.0, 0.0, 0.11]))
        slip_m, _ = await slip_while_held(reach, "part")
        assert slip_m < 0.003
        assert reach.part("part")[0][2] > low[2] + 0.09
        assert held(reach) == HandGrasp(part="part")


@pytest.mark.virtual
@pytest.mark.parametrize("shape", [nightly("sphere"), "box", nightly("cylinder")])
async def test_a_part_is_not_held_at_twenty_percent_and_the_hand_knows(shape: str) -> None:
    part = PARTS[shape]
    async with reaching(cell(part)) as reach:
        await reach_for(reach, part)
        assert (await close(reach, 0.2)).end is MotionEnd.REACHED
        assert held(reach).part == ""
        assert held(reach).reason != ""
        await go(reach, around(part) + np.array([0.0, 0.0, 0.11]))
        assert reach.part("part")[0][2] < PART_XYZ[2] + 0.01


@pytest.mark.virtual
async def test_a_cylinder_is_placed_upright_within_ten_millimetres() -> None:
    async with reaching(cell(CYLINDER)) as reach:
        start, _ = reach.part("part")
        await reach_for(reach, CYLINDER)
        await close(reach, 0.7)
        await go(reach, around(CYLINDER) + np.array([0.0, 0.0, 0.1]))
        await asyncio.sleep(2.0)
        await go(reach, around(CYLINDER) + np.array([0.0, 0.0, 0.003]))
        assert (await close(reach, 0.0)).end is MotionEnd.REACHED
        await go(reach, around(CYLINDER) - np.array([0.0, 0.1, 0.0]))
        await asyncio.sleep(0.5)
        xyz, turn = reach.part("part")
        assert float(np.linalg.norm(xyz - start)) < 0.01
        assert turn.as_matrix()[2, 2] > 0.999
        assert held(reach) == HandGrasp(reason="the hand is open")


@pytest.mark.virtual
async def test_a_hand_that_closes_on_nothing_says_so_and_takes_the_time_it_was_given() -> None:
    async with reaching(scene("panda", "softhand")) as reach:
        start_s = reach.world.measured().time_s
        assert (await close(reach, 0.7, time_s=2.0)).end is MotionEnd.REACHED
        assert reach.world.measured().time_s - start_s == pytest.approx(2.0, abs=0.3)
        assert measured(reach).closed_share == pytest.approx(0.7)
        assert held(reach) == HandGrasp(reason="the hand closed to 70 % and touches nothing")


@pytest.mark.virtual
async def test_fingers_that_are_blocked_stop_and_the_others_go_on() -> None:
    """A rail lies along the inner side of the index finger."""
    rail = FixtureBody(name="rail", shape="box", size_m=(0.15, 0.01, 0.02), pose=Pose(xyz=(0.6, -0.015, 0.695)))
    async with reaching(scene("panda", "softhand", fixtures=(rail,))) as reach:
        await reach_for(reach, CYLINDER)
        await close(reach, 0.6)
        assert bend_rad(reach, "little") > bend_rad(reach, "index") + 0.5


def bend_rad(reach: Reach, finger: str) -> float:
    """How far a finger's last link is turned from its knuckle."""
    _, knuckle = reach.part(f"{ARM}/softhand_{finger}_knuckle")
    _, tip = reach.part(f"{ARM}/softhand_{finger}_distal")
    return float(Rotation.magnitude(tip * knuckle.inv()))


@pytest.mark.virtual
async def test_a_hand_cancelled_on_its_way_stops_there() -> None:
    async with reaching(scene("panda", "softhand")) as reach:
        motion = reach.world.hand(ARM).close_to(share=1.0, time_s=2.0)
        await asyncio.sleep(1.0)
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert measured(reach).closed_share == pytest.approx(0.5, abs=0.05)


@pytest.mark.virtual
async def test_a_restored_hand_holds_on_to_its_part() -> None:
    async with reaching(cell(CYLINDER)) as reach:
        await reach_for(reach, CYLINDER)
        await close(reach, 0.7)
        await go(reach, around(CYLINDER) + np.array([0.0, 0.0, 0.1]))
        before, snapshot = reach.part("part")[0], reach.world.snapshot()
    async with reaching(cell(CYLINDER)) as reach:
        await reach.world.restore(snapshot)
        await asyncio.sleep(1.0)
        assert held(reach) == HandGrasp(part="part")
        assert reach.strayed_m("part", before) < 0.003

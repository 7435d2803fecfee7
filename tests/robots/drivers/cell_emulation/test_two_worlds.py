"""A part is where the world has it whose tool has taken it first, in both worlds, until it lies still again."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping

import numpy as np
import pytest
from msgspec.structs import replace

from engine.messages import Pose, Vector3
from robots.drivers.cell_emulation.two_worlds import TwoWorlds
from robots.drivers.franka.emulation.simulator_messages import PartReport, RobotReport, SimulatorReport
from robots.port import Array, Tolerance
from robots.sim.world.sim_world import SimWorld, new_world
from tests.robots.sim.sim_cell import ABOVE_PART, AT_PART, HOME, LEFT, PART_XYZ, RIGHT, box, smooth, two_arms

LYING = (0.3, -0.3, 0.02)
HELD = (0.3, -0.3, 0.25)


class OtherWorld:
    """The world of the Franka arm: where the test says, and where it is told to keep parts."""

    def __init__(self, world: SimWorld) -> None:
        self.kept: dict[str, Pose] = {}
        self.worlds = TwoWorlds(world, ("right",), self)
        self._world = world
        self._time_s = 0.0
        self._start_s = asyncio.get_running_loop().time()

    def keep(self, parts: Mapping[str, Pose | None]) -> None:
        for name, pose in parts.items():
            if pose is None:
                self.kept.pop(name)
            else:
                self.kept[name] = pose

    def pass_time(self, duration_s: float) -> None:
        """Step the world of the others."""
        self._time_s += duration_s
        until_s = self._start_s + self._time_s
        while self._world.advance(until_s) < until_s:
            pass

    def report(self, cube: Vector3, *, touched: bool, joints: float = 0.0, reports: int = 1) -> None:
        """Report as the simulator does every 20 ms."""
        for _ in range(reports):
            self.worlds.take(
                SimulatorReport(
                    time_s=self._time_s + 0.02,
                    late_s=0.0,
                    robots=(
                        RobotReport(
                            position_rad=tuple((HOME + joints).tolist()),
                            fastest_rad_s=0.0,
                            width_m=0.03,
                            touched=("cube",) if touched else (),
                        ),
                    ),
                    parts={"cube": PartReport(xyz=cube, xyzw=(0.0, 0.0, 0.0, 1.0))},
                )
            )
            self.pass_time(0.02)


def world(cube: Vector3 = LYING) -> SimWorld:
    """Return a world with an arm of its own, one of the other world, and a part."""
    scene = two_arms(box("cube", cube))
    return new_world(replace(scene, arms=(LEFT_WITH_HAND, replace(RIGHT, driven=True))), virtual=True)


LEFT_WITH_HAND = replace(LEFT, gripper="panda_hand")


def where(world: SimWorld) -> Array:
    return np.array(world.measured().frame("cube")[0])


async def test_an_arm_and_the_part_in_its_fingers_are_where_the_other_world_has_them_until_it_lies_still() -> None:
    async with world() as here:
        there = OtherWorld(here)
        there.report(LYING, touched=True)
        there.report(HELD, touched=True, joints=0.3, reports=10)
        assert here.measured().arm("right").position_rad == pytest.approx(HOME + 0.3)
        assert where(here) == pytest.approx(HELD, abs=1e-4)
        # It falls there, and lies there: here it does not fall another way.
        for height_m in (0.24, 0.2, 0.1):
            there.report((0.3, -0.3, height_m), touched=False)
            assert where(here) == pytest.approx((0.3, -0.3, height_m), abs=1e-4)
        there.report((0.35, -0.3, 0.02), touched=False, reports=2)
        assert there.kept == {}
        there.report((0.35, -0.3, 0.02), touched=False, reports=20)
        assert where(here) == pytest.approx((0.35, -0.3, 0.02), abs=1e-3)
        # Free again: it is not kept here, so that a push moves it, and the other world is told.
        here.push("cube", force_n=(3.0, 0.0, 0.0), duration_s=0.2)
        there.report((0.35, -0.3, 0.02), touched=False, reports=9)
        assert where(here)[0] > 0.36
        assert there.kept["cube"].xyz[0] > 0.36


async def test_a_part_that_lies_still_is_kept_in_neither_world() -> None:
    async with world() as here:
        there = OtherWorld(here)
        there.report(LYING, touched=False, reports=5)
        here.push("cube", force_n=(3.0, 0.0, 0.0), duration_s=0.1)
        there.report(LYING, touched=False, reports=50)
        moved = there.kept["cube"]
        there.report(moved.xyz, touched=False, reports=2)
        assert there.kept == {}


@pytest.mark.parametrize("first", ["here", "there"])
async def test_who_touches_a_part_first_has_it_until_it_lets_go(first: str) -> None:
    async with world(PART_XYZ) as here:
        there = OtherWorld(here)
        hand = here.gripper("left")
        for start, goal in ((HOME, ABOVE_PART), (ABOVE_PART, AT_PART)):
            here.arm("left").follow(smooth(start, goal, 1.0), tolerance=Tolerance(path_rad=1.0))
            there.pass_time(2.0)
        there.report(PART_XYZ, touched=first == "there")
        closing = hand.close_to(width_m=0.0, speed_m_s=0.1, force_n=30.0)
        there.report(PART_XYZ, touched=first == "there", reports=40)
        assert "cube" in here.measured().tool("left").contacts
        # The other hand takes it too.
        there.report(PART_XYZ, touched=True, reports=3)
        assert ("cube" in there.kept) is (first == "here")
        if first == "here":
            closing.cancel()
            hand.close_to(width_m=0.08, speed_m_s=0.1, force_n=30.0)
            there.report(PART_XYZ, touched=True, reports=40)
            assert there.kept == {}
        else:
            there.report(PART_XYZ, touched=False)
            assert "cube" in there.kept

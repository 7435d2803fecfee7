"""The world's process waits for nobody: not for who hears it, not for who watches."""

from __future__ import annotations

import os
import re

import numpy as np
import pytest

from robots.port import MotionEnd, Tolerance
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import HOME, move, one_arm, smooth, until, watched


async def test_the_world_goes_on_while_the_loop_of_its_parent_is_blocked() -> None:
    """Where the cell lets the engine be silent for so long: this test never lets the loop turn."""
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        # Before the motion: the world may have gone on until this process looks again.
        began_s = world.measured().time_s
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.05, 0.3), tolerance=Tolerance())
        # Where it ends is looked at, and not that it moves: this process may be kept from looking for longer than that.
        while not np.allclose(world.measured().arm("left").desired_rad, HOME + 0.05, rtol=0.0, atol=1e-9):
            os.sched_yield()
        while world.measured().arm_progress("left", 1) is not None:
            os.sched_yield()
        assert world.measured().time_s - began_s >= 0.3
        assert world.measured().arm("left").desired_rad.tolist() == pytest.approx((HOME + 0.05).tolist())
        assert (await motion.report()).end.value == "reached"


async def test_an_arm_comes_to_rest_by_itself_while_the_loop_of_its_parent_is_blocked_and_then_moves_again() -> None:
    host = ProcessHost(watched(one_arm()))
    async with SimWorld(one_arm(), host=host) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, HOME + 1.0, 60.0), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.001)
        # Nothing here lets the loop turn: what ends the motion is the world itself.
        while world.measured().arm_progress("left", 1) is not None:
            os.sched_yield()
        at_rest = world.measured().arm("left")
        assert abs(at_rest.velocity_rad_s).max() < 0.01
        report = await motion.report()
        silence, _, device = report.reason.partition("; ")
        assert (report.end, device) == (MotionEnd.FAILED, "left came to rest by itself")
        assert re.fullmatch(r"the engine has been silent for 1\.\d s", silence)
        # On a loaded machine this loop may be silent once more.
        while (await move(arm, HOME, 0.3)).end is not MotionEnd.REACHED:
            pass


async def test_fingers_come_to_rest_by_themselves_as_well() -> None:
    host = ProcessHost(watched(one_arm()))
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.gripper("left").close_to(width_m=0.0, speed_m_s=0.002, force_n=10.0)
        await until(lambda: motion.progress > 0.01)
        while world.measured().tool_progress("left", 1) is not None:
            os.sched_yield()
        report = await motion.report()
        assert report.end is MotionEnd.FAILED
        assert report.reason.endswith("; left/gripper came to rest by itself")
        assert world.gripper("left").sample().width_m > 0.01

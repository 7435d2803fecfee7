"""The ports of a simulated world: what cannot be sent is not under way."""

from __future__ import annotations

import pytest

from engine.errors import RobotError
from engine.robot import DeviceStatus
from robots.port import MotionEnd, Tolerance
from robots.sim.commands.world_commands import AnyCommand
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import HOME, move, one_arm, smooth


class DeafHost(LockstepHost):
    """Refuses commands while it is deaf."""

    deaf = False

    def send(self, command: AnyCommand) -> None:
        if self.deaf:
            raise RobotError("the line is dead")
        super().send(command)


@pytest.mark.virtual
async def test_a_motion_that_could_not_be_sent_leaves_nothing_behind() -> None:
    """Else the world would wait for ever for its end, and the arm refuse the next one."""
    host = DeafHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        host.deaf = True
        with pytest.raises(RobotError, match="the line is dead"):
            world.arm("left").follow(smooth(HOME, HOME + 0.1, 0.3), tolerance=Tolerance())
        with pytest.raises(RobotError, match="the line is dead"):
            world.gripper("left").close_to(width_m=0.0, speed_m_s=0.1, force_n=20.0)
        assert world.status is DeviceStatus.READY
        host.deaf = False
        assert (await move(world.arm("left"), HOME + 0.1, 0.3)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_hold_that_could_not_be_sent_is_reported_and_the_next_one_works() -> None:
    host = DeafHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.1, 0.5), tolerance=Tolerance())
        host.deaf = True
        with pytest.raises(RobotError, match="the line is dead"):
            await motion.hold()
        host.deaf = False
        await motion.hold()
        assert motion.progress < 1.0
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED

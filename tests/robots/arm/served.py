"""One arm over a fake port on a bus, for tests of its skills."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.bus import GoalHandle, GoalStatus, SkillBus
from engine.clock import new_clock
from engine.skill import Action
from engine.skills.arm_control import ArmMode, ReadArm
from engine.skills.motion import JointTrapVel
from robots.arm import ArmServer
from robots.arm.services.output_services import OutputServices
from robots.model import RobotModel
from tests.robots.fake_port import FakeArmPort, FakeStream
from tests.robots.panda_arm import BASE, home, panda_model

ELSEWHERE = (0.4, -0.4, 0.1, -2.0, 0.0, 1.6, 0.9)
MOVE = JointTrapVel(joints=ELSEWHERE, speed=0.5)
HOME = JointTrapVel(joints=tuple(home()), speed=0.5)


@dataclass(frozen=True)
class Served:
    """A bus with one arm named `left` on it."""

    bus: SkillBus
    arm: ArmServer
    port: FakeArmPort

    @property
    def stream(self) -> FakeStream:
        """The stream under way, or the last one."""
        assert isinstance(self.port.motion, FakeStream)
        return self.port.motion

    async def begun(self, goal: Action[Any, Any], *, after_s: float = 0.2) -> GoalHandle[Any, Any]:
        """Send a goal and let it run for a while."""
        handle = self.bus.send_goal(goal, to="left")
        await handle.accepted()
        await self.bus.clock.sleep(after_s)
        return handle

    async def status_of_next(self) -> GoalStatus:
        """Send a joint motion and return how it ends: what the arm takes after something else."""
        return (await self.bus.send_goal(MOVE, to="left").result()).status

    async def mode(self) -> ArmMode:
        """What the arm says it does."""
        return (await self.bus.call(ReadArm(), to="left")).mode


@asynccontextmanager
async def served(
    *,
    outputs: OutputServices | None = None,
    model: RobotModel | None = None,
    port_type: type[FakeArmPort] = FakeArmPort,
) -> AsyncGenerator[Served]:
    """The left arm, a Panda unless said otherwise, connected and on a bus."""
    model = model or panda_model()
    port = port_type(model.arm_joints, np.array(model.home_rad))
    arm = ArmServer(
        name="left",
        model=model,
        base=BASE.to_pose("world"),
        port=port,
        clock=new_clock(),
        outputs=outputs,
    )
    async with SkillBus(new_clock()) as bus, arm:
        arm.register(bus)
        yield Served(bus, arm, port)

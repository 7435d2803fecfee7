"""A Panda at a table in physics, with its skills on a bus: what the arm really does."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from engine.bus import GoalEnd, GoalHandle, SkillBus
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.messages import Pose, Vector3
from engine.skill import Action
from engine.skills.arm_control import ArmMode, ReadArm
from engine.skills.motion import ForwardKinematics, JointTrapVel
from robots.port import ArmPort, Array
from robots.sim.world.sim_world import SimWorld
from robots.simulated_cell import new_world
from tests.robots.panda_arm import home

CELL = Path(__file__).with_name("one_panda.yaml")
HOME = JointTrapVel(joints=tuple(home().tolist()), speed=0.5)
THERE = JointTrapVel(joints=(0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8), speed=0.5)


@dataclass(frozen=True)
class Simulated:
    """The open cell."""

    bus: SkillBus
    world: SimWorld

    @property
    def port(self) -> ArmPort:
        """The arm's port, for what it measures."""
        return self.world.arm("left")

    def speed_rad_s(self) -> float:
        """The speed of the fastest joint."""
        return float(np.abs(self.port.sample().velocity_rad_s).max())

    def joints(self) -> Array:
        """The measured joints."""
        return self.port.sample().position_rad.copy()

    async def tool(self) -> Pose:
        """Where the tool is measured."""
        return await self.bus.call(ForwardKinematics(), to="left")

    async def mode(self) -> ArmMode:
        """What the arm says it does."""
        return (await self.bus.call(ReadArm(), to="left")).mode

    async def perform(self, goal: Action[Any, Any]) -> GoalEnd[Any]:
        """Send a goal and wait for its end."""
        return await self.bus.send_goal(goal, to="left").result()

    async def begun(self, goal: Action[Any, Any], *, after_s: float = 0.3) -> GoalHandle[Any, Any]:
        """Send a goal and let it run for a while."""
        handle = self.bus.send_goal(goal, to="left")
        await handle.accepted()
        await self.bus.clock.sleep(after_s)
        return handle

    def push(self, force_n: Vector3, *, duration_s: float, body: str = "left/panda_hand") -> None:
        """Push as a hand does."""
        self.world.push(body, force_n=force_n, duration_s=duration_s)

    async def until(self, condition: Callable[[], bool], *, within_s: float) -> float:
        """Return the time after which `condition` holds."""
        clock = self.bus.clock
        start_s = clock.now_s()
        while not condition():
            assert clock.now_s() < start_s + within_s
            await clock.sleep(0.002)
        return clock.now_s() - start_s


@asynccontextmanager
async def simulated() -> AsyncGenerator[Simulated]:
    """The cell in lockstep with virtual time."""
    async with AsyncExitStack() as stack:
        bus = await stack.enter_async_context(SkillBus(new_clock()))
        world = await stack.enter_async_context(new_world(load_cell(CELL), bus=bus, virtual=True, seed=None))
        world.register(bus)
        for robot in world.robots():
            await stack.enter_async_context(robot)
            robot.register(bus)
        yield Simulated(bus, world)

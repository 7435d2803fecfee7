"""An arm without inertia that a page jogs, with the log of its joints."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from editor_web.teaching.jogging import LEAST_PRESS_S, WATCHDOG_S, Jogger, ToPage
from editor_web.teaching.teaching_messages import PressDropped, RefusedFrame, StartJog
from engine.bus.json_bus import LocalJsonBus
from robots.control.generators.damped_inverse import joint_velocity
from robots.port import Array
from tests.robots.fake_port import FakeStream
from tests.robots.panda_arm import panda_kinematics
from tests.robots.workspace.fake_cell import FakeCell, fake_cell

STEP_S, REPEAT_S = 0.005, 0.04
STRAIGHT = 0.99


@dataclass(frozen=True)
class Press:
    """A key: what it jogs and how fast, and how long it is down."""

    jog: StartJog
    velocity: tuple[float, ...]
    hold_s: float = 0.0

    @property
    def axis(self) -> int:
        """The number of the axis or joint."""
        return int(np.argmax(np.abs(self.velocity)))

    @property
    def speed(self) -> float:
        """How fast, in m/s or rad/s."""
        return float(np.linalg.norm(self.velocity))

    def along(self, joints: Array, change: Array) -> float:
        """Return how far a change of the joints goes this way, in metres or radians; 0 if it goes another way."""
        if self.jog.space == "joints":
            done, told = change, np.array(self.velocity)
        else:
            pose, jacobian = panda_kinematics().tool_pose_and_jacobian(joints)
            # The base of the arm is not turned in the world.
            axes = pose.rotation if self.jog.frame == "tool" else np.eye(3)
            told = np.concatenate((axes @ self.velocity[:3], axes @ self.velocity[3:]))
            done = jacobian @ change
        length = float(np.linalg.norm(done))
        straight = float(done @ told) / max(1e-12, length * float(np.linalg.norm(told)))
        return length if straight > STRAIGHT else 0.0


@dataclass
class Jogged:
    """An arm without inertia that a page jogs."""

    cell: FakeCell
    jogger: Jogger
    told: list[ToPage]
    log: list[Array]
    moved_s: list[float]
    """When it moved, of the loop's time."""

    async def press(self, press: Press) -> None:
        """Hold the key down as the page does."""
        await self.jogger.begin(press.jog)
        await self.jogger.go(press.velocity)
        left_s = press.hold_s
        while left_s > 0.0:
            await self.wait(min(REPEAT_S, left_s))
            left_s -= REPEAT_S
            await self.jogger.go(press.velocity)
        await self.jogger.release()

    async def wait(self, time_s: float) -> None:
        await self.cell.bus.clock.sleep(time_s)

    def gone(self, press: Press) -> float:
        """How far the arm has gone the way of a press, in metres or radians."""
        return sum(press.along(before, after - before) for before, after in pairwise(self.log))

    @property
    def dropped(self) -> int:
        """How many presses the page was told of that have moved nothing."""
        return sum(isinstance(message, PressDropped) for message in self.told)

    @property
    def refusals(self) -> list[str]:
        return [message.message for message in self.told if isinstance(message, RefusedFrame)]


@asynccontextmanager
async def jogged() -> AsyncGenerator[Jogged]:
    async with fake_cell() as cell:
        told: list[ToPage] = []
        jogger = Jogger(LocalJsonBus(cell.bus), taken={}, send=told.append)
        arm = Jogged(cell, jogger, told, [cell.port.sample().position_rad.copy()], [])
        moving = asyncio.create_task(follow(arm))
        try:
            yield arm
        finally:
            await jogger.rest()
            moving.cancel()


async def follow(arm: Jogged) -> None:
    """Move the arm as it is told, until its watchdog expires, and log its joints."""
    cell, log = arm.cell, arm.log
    count, silent_s = 0, 0.0
    while True:
        await cell.bus.clock.sleep(STEP_S)
        stream = cell.port.motion
        if not isinstance(stream, FakeStream) or stream.ended or not stream.sent:
            count = 0
            continue
        silent_s = silent_s + STEP_S if len(stream.sent) == count else stream.ages_s[-1]
        count = len(stream.sent)
        if silent_s > WATCHDOG_S:
            continue
        joints, told = log[-1], np.array(stream.sent[-1])
        if told.any():
            arm.moved_s.append(cell.bus.clock.now_s())
        if len(told) == 6:
            told = joint_velocity(panda_kinematics().tool_pose_and_jacobian(joints)[1], told)
        log.append(joints + told * STEP_S)
        cell.port.lead_to(tuple(log[-1].tolist()))


def least(press: Press) -> float:
    """The least way of a press, but for two periods of the log."""
    return (LEAST_PRESS_S - 2.0 * STEP_S) * press.speed

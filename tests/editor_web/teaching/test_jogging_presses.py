"""Every press moves the tool its way, however short it is and whatever was pressed before: by logs of the pose."""

from __future__ import annotations

import asyncio
import random
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest

from editor_web.teaching.jogging import LEAST_PRESS_S, WATCHDOG_S, Jogger
from editor_web.teaching.teaching_messages import JogStatus, RefusedFrame, StartJog
from engine.bus import GoalStatus
from engine.bus.json_bus import CLI_HOLDER, LocalJsonBus
from engine.skills.jogging import StepJoints
from robots.control.generators.damped_inverse import joint_velocity
from robots.port import Array
from tests.robots.fake_port import FakeStream
from tests.robots.panda_arm import panda_kinematics
from tests.robots.workspace.fake_cell import FakeCell, fake_cell

STEP_S, REPEAT_S = 0.005, 0.04
M_S, RAD_S = 0.04, 0.15
PRESSES, SEED = 100, 7
HOLDS_S = (0.0, 0.01, 0.06, 0.13)
PAUSES_S = (0.0, 0.02, 0.1)
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
    told: list[JogStatus | RefusedFrame]
    log: list[Array]

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
    def refusals(self) -> list[str]:
        return [message.message for message in self.told if isinstance(message, RefusedFrame)]


@asynccontextmanager
async def jogged() -> AsyncGenerator[Jogged]:
    async with fake_cell() as cell:
        told: list[JogStatus | RefusedFrame] = []
        jogger = Jogger(LocalJsonBus(cell.bus), taken={}, send=told.append)
        log = [cell.port.sample().position_rad.copy()]
        moving = asyncio.create_task(follow(cell, log))
        try:
            yield Jogged(cell, jogger, told, log)
        finally:
            await jogger.rest()
            moving.cancel()


async def follow(cell: FakeCell, log: list[Array]) -> None:
    """Move the arm as it is told, until its watchdog expires, and log its joints."""
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
        if len(told) == 6:
            told = joint_velocity(panda_kinematics().tool_pose_and_jacobian(joints)[1], told)
        log.append(joints + told * STEP_S)
        cell.port.lead_to(tuple(log[-1].tolist()))


def any_press(random_: random.Random) -> Press:
    """A press of any key of the panel."""
    hold_s, sign = random_.choice(HOLDS_S), random_.choice((1.0, -1.0))
    if random_.random() < 0.15:
        joint = random_.randrange(7)
        velocity = tuple(sign * RAD_S if at == joint else 0.0 for at in range(7))
        return Press(StartJog(arm="left", space="joints"), velocity, hold_s)
    axis = random_.randrange(6)
    velocity = tuple(sign * (M_S if at < 3 else RAD_S) if at == axis else 0.0 for at in range(6))
    frame = random_.choice(("world", "base", "tool"))
    return Press(StartJog(arm="left", space="tool", frame=frame), velocity, hold_s)


def opposite(press: Press) -> Press:
    return Press(press.jog, tuple(-value + 0.0 for value in press.velocity), press.hold_s)


@pytest.mark.virtual
async def test_none_of_a_hundred_changes_of_direction_is_lost() -> None:
    """Of axis, sign, frame and mode: every press is executed in its turn, its way, and for its shortest time."""
    random_ = random.Random(SEED)
    presses: list[Press] = []
    while len(presses) < PRESSES:
        first = any_press(random_)
        if not presses or presses[-1].axis != first.axis:
            # There and back, so that the arm stays far from everything.
            presses += [first, opposite(first)]
    async with jogged() as arm:
        for press in presses:
            await arm.press(press)
            await arm.wait(random_.choice(PAUSES_S))
        await arm.wait(2.0 * LEAST_PRESS_S)
        log, refusals = arm.log, arm.refusals
    assert refusals == []
    gone = [0.0] * len(presses)
    now = 0
    for before, after in pairwise(log):
        change = after - before
        if not change.any():
            continue
        if not presses[now].along(before, change):
            now += 1
        far = presses[now].along(before, change)
        assert far > 0.0, f"after press {now} of {len(presses)} the arm goes another way than any key says"
        gone[now] += far
    short = [k for k, (far, press) in enumerate(zip(gone, presses, strict=True)) if far < least(press)]
    assert short == [], f"{len(short)} presses moved too little: {[(presses[k], gone[k]) for k in short]}"


def least(press: Press) -> float:
    """The least way of a press, but for two periods of the log."""
    return (LEAST_PRESS_S - 2.0 * STEP_S) * float(np.linalg.norm(press.velocity))


UP = Press(StartJog(arm="left", space="tool"), (0.0, 0.0, M_S, 0.0, 0.0, 0.0))
SIDE = Press(StartJog(arm="left", space="tool"), (0.0, M_S, 0.0, 0.0, 0.0, 0.0))


@pytest.mark.virtual
async def test_one_goal_serves_all_presses_and_ends_a_second_after_the_last() -> None:
    async with jogged() as arm:
        for press in (UP, SIDE, UP):
            await arm.press(press)
            await arm.wait(0.4)
        assert len(arm.cell.port.streamed) == 1
        assert arm.jogger.arm == ""
        await arm.wait(1.2)
        assert arm.cell.bus.goals() == ()
        await arm.press(SIDE)
        await arm.wait(0.3)
        assert len(arm.cell.port.streamed) == 2


@pytest.mark.virtual
async def test_another_goal_takes_the_arm_while_nothing_is_pressed_and_not_before() -> None:
    """A step of the same page, in the second in which the jog stays open."""
    step = StepJoints(step_rad=(0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    async with jogged() as arm:
        await arm.jogger.begin(UP.jog)
        await arm.jogger.go(UP.velocity)
        await arm.wait(0.05)
        busy = await arm.cell.bus.send_goal(step, to="left", holder=CLI_HOLDER).result()
        assert busy.status is GoalStatus.REJECTED
        await arm.jogger.release()
        await arm.wait(2.0 * LEAST_PRESS_S)
        stepped = await arm.cell.bus.send_goal(step, to="left", holder=CLI_HOLDER).result()
        assert stepped.status is GoalStatus.SUCCEEDED
        assert arm.refusals == []


@pytest.mark.virtual
async def test_a_press_waits_a_second_for_its_check_and_no_longer() -> None:
    """Whoever has let go of a key is not surprised by it later."""
    async with jogged() as arm:
        await arm.press(UP)
        await arm.wait(0.3)
        gone = arm.gone(UP)
        arm.cell.planner.silent_s = 0.25
        await arm.press(SIDE)
        await arm.wait(0.6)
        assert arm.gone(SIDE) >= least(SIDE)
        arm.cell.planner.silent_s = 9.0
        await arm.press(UP)
        await arm.wait(1.1)
        arm.cell.planner.silent_s = 0.0
        await arm.wait(1.0)
        assert arm.gone(UP) == gone


@pytest.mark.virtual
async def test_a_page_that_goes_takes_its_unfinished_presses_with_it() -> None:
    """Its connection is cut between the release and the motion."""
    async with jogged() as arm:
        arm.cell.planner.silent_s = 0.2
        await arm.press(UP)
        await arm.wait(0.05)
        await arm.jogger.rest()
        await arm.wait(1.0)
        assert (arm.gone(UP), arm.cell.bus.goals()) == (0.0, ())

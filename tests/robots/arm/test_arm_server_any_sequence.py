"""Whatever an arm is told in whatever order: one motion at a time, within limits, at rest when stopped, and usable."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Awaitable, Callable
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalHandle, GoalStatus
from engine.clock import run_virtual
from engine.errors import FlexcellError
from engine.skills.arm_control import (
    ArmStatus,
    RecoverFromError,
    SetCartesianImpedance,
    SetCollisionBehavior,
    SetController,
    SetEndEffectorFrame,
    SetJointImpedance,
    SetLoad,
    SetSpeedOverride,
)
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.guiding import FinishGuiding
from engine.skills.jogging import JogCommand
from tests.robots.arm.every_skill import LOWER, MAKERS, UPPER, near_home, some
from tests.robots.arm.simulated import HOME, Simulated, simulated
from tests.tiers import nightly

OPERATIONS = 40
REST_RAD_S = 0.02
STOPPED_WITHIN_S = 2.0
GARBAGE: tuple[Any, ...] = ((), (0.1,), (float("nan"),) * 7, (float("inf"),) * 6, (1.7e308,) * 7, "fast", None, ("a",))


class Operator:
    """Does anything at any time, and looks at what the arm does meanwhile."""

    def __init__(self, cell: Simulated, random_: random.Random) -> None:
        self._cell = cell
        self._random = random_
        self._goals: list[GoalHandle[Any, Any]] = []
        self._asked: set[asyncio.Task[Any]] = set()
        self._told: list[ArmStatus] = []
        cell.bus.topic("left/status", ArmStatus).subscribe(self._told.append)
        self.log: list[str] = []

    async def act(self) -> None:
        """Do one thing, let some time pass, and look."""
        choices: list[tuple[float, Callable[[], Awaitable[None]]]] = [
            (4.0, self._start), (1.0, self._cancel), (1.0, self._hold), (1.5, self._resume), (0.7, self._stop),
            (2.0, self._set), (1.0, self._push), (1.5, self._recover), (3.0, self._publish), (1.5, self._direct),
            (0.7, self._finish),
        ]  # fmt: skip
        (act,) = self._random.choices([act for _, act in choices], [weight for weight, _ in choices])
        self.log.append(act.__name__)
        await act()
        for _ in range(self._random.choice((0, 1, 3, 15))):
            await self._cell.bus.clock.sleep(0.02)
            self.look()

    def look(self) -> None:
        """Compare what the arm does with what it says and may."""
        cell, sample = self._cell, self._cell.port.sample()
        moving = [handle.address for handle in self._goals if handle.status in _UNDER_WAY and not handle.finished]
        assert len(moving) <= 1
        assert np.isfinite(sample.desired_rad).all()
        # While a hand leads the arm, the set point is where the hand has led it.
        assert (sample.desired_rad >= LOWER - 0.02).all()
        assert (sample.desired_rad <= UPPER + 0.02).all()
        now = cell.bus.topic("left/status", ArmStatus).latest
        assert now is not None
        told = self._told[-1] if self._told else now
        assert (told.activity, told.settings) == (now.activity, now.settings)
        # A reflex is told with the next change: when the motion that it ended is over, or something else begins.
        said, is_ = (told.mode, told.error), (now.mode, now.error)
        assert said == is_ or sample.reflex, f"said {said}, is {is_}"
        if moving:
            assert now.mode in ("moving", "jogging", "guiding")
            assert now.activity == moving[0].rpartition("/")[2]

    async def end(self) -> None:
        """Stop the arm, put it right, and let it go home."""
        await self._stop()
        for task in self._asked:
            await asyncio.wait_for(task, STOPPED_WITHIN_S)
        cell = self._cell
        assert all(handle.finished for handle in self._goals)
        assert await cell.mode() in ("idle", "reflex")
        requests: tuple[Any, ...] = (
            SetCollisionBehavior(), SetLoad(mass_kg=0.0), SetController(controller="joint_impedance"),
            SetJointImpedance(), SetSpeedOverride(share=1.0), RecoverFromError(),
        )  # fmt: skip
        for request in requests:
            await cell.bus.call(request, to="left")
        await cell.bus.clock.sleep(0.5)
        home = await cell.perform(HOME)
        assert home.status is GoalStatus.SUCCEEDED, home.cause
        assert await cell.mode() == "idle"

    async def _start(self) -> None:
        goal = self._random.choice(MAKERS)(self._cell.joints(), self._random)
        self.log[-1] += f" {goal.skill_name()}"
        self._goals.append(self._cell.bus.send_goal(goal, to="left"))

    async def _cancel(self) -> None:
        for handle in self._goals[-2:]:
            handle.cancel()

    async def _hold(self) -> None:
        self._ask([handle.hold() for handle in self._goals[-1:]])

    async def _resume(self) -> None:
        self._ask([handle.resume() for handle in self._goals[-1:]])

    def _ask(self, asked: list[Any]) -> None:
        """A hold may wait for a goal to begin, and a resume for a hold: nobody waits for them here."""
        self._asked.update(asyncio.ensure_future(each) for each in asked)

    async def _stop(self) -> None:
        (arm,) = (robot for robot in self._cell.world.robots() if robot.name == "left")
        await asyncio.wait_for(arm.stop(), STOPPED_WITHIN_S)
        assert self._cell.speed_rad_s() < REST_RAD_S
        # Goals whose motion has ended say so as soon as they are let.
        await self._cell.bus.clock.sleep(0.0)
        assert await self._cell.mode() in ("idle", "reflex")

    async def _set(self) -> None:
        random_ = self._random
        stiff = random_.uniform(100.0, 3000.0)
        requests: tuple[Any, ...] = (
            SetSpeedOverride(share=random_.choice((0.2, 0.5, 1.0))),
            SetController(controller=random_.choice(("joint_impedance", "cartesian_impedance"))),
            SetJointImpedance(damping_ratio=random_.uniform(0.5, 1.5)),
            SetCartesianImpedance(stiffness=(stiff, stiff, stiff, 100.0, 100.0, 100.0)),
            SetEndEffectorFrame(xyz_m=(0.0, 0.0, random_.choice((0.0, 0.1)))),
            SetLoad(mass_kg=random_.choice((0.0, 0.3))),
            SetCollisionBehavior(force_n=random_.choice((None, 25.0))),
        )
        await self._call(random_.choice(requests))

    async def _call(self, request: Any) -> None:
        self.log[-1] += f" {request.skill_name()}"
        refusal = ""
        try:
            await asyncio.wait_for(self._cell.bus.call(request, to="left"), STOPPED_WITHIN_S)
        except FlexcellError as error:
            refusal = error.message
        assert "service raised" not in refusal, refusal

    async def _push(self) -> None:
        x, y, z = some(self._random, self._random.choice((5.0, 30.0)), 3)
        self._cell.push((x, y, z), duration_s=self._random.uniform(0.02, 0.2))

    async def _recover(self) -> None:
        await self._call(RecoverFromError())

    async def _finish(self) -> None:
        await self._call(FinishGuiding())

    async def _direct(self) -> None:
        await self._call(SwitchDirectControl(on=self._random.random() < 0.5, watchdog_s=0.2))

    async def _publish(self) -> None:
        random_ = self._random
        bad = random_.random() < 0.3
        velocity = random_.choice(GARBAGE) if bad else some(random_, 0.2, random_.choice((6, 7)))
        self._cell.bus.topic("left/jog", JogCommand).publish(JogCommand(velocity=velocity))
        joints = random_.choice(GARBAGE) if bad else near_home(random_)
        self._cell.bus.topic("left/direct_joints", JointCommand).publish(JointCommand(position_rad=joints))


_UNDER_WAY = (GoalStatus.ACTIVE, GoalStatus.HELD, GoalStatus.CANCELING)


@pytest.mark.parametrize("seed", [0, 1, 2, *map(nightly, range(3, 8))])
@pytest.mark.virtual
async def test_after_any_sequence_of_operations_a_stop_ends_everything_and_the_arm_goes_home(seed: int) -> None:
    async with simulated() as cell:
        operator = Operator(cell, random.Random(seed))
        try:
            for _ in range(OPERATIONS):
                await operator.act()
            await operator.end()
        except BaseException as error:
            error.add_note(" · ".join(operator.log))
            raise
        for topic in ("left/jog", "left/direct_joints"):
            assert cell.bus.find_topic(topic).subscriber_count == 1, f"garbage has silenced {topic}"


async def _observed(seed: int) -> tuple[str, ...]:
    """Return what an arm said and where it was, as text, over a sequence of operations."""
    async with simulated() as cell:
        operator, seen = Operator(cell, random.Random(seed)), list[str]()
        cell.bus.topic("left/status", ArmStatus).subscribe(lambda status: seen.append(repr(status)))
        for _ in range(OPERATIONS):
            await operator.act()
            seen.append(cell.port.sample().position_rad.tobytes().hex())
        await operator.end()
        return (*seen, *operator.log)


def test_the_same_operations_give_the_same_bits() -> None:
    assert run_virtual(_observed(3)) == run_virtual(_observed(3))

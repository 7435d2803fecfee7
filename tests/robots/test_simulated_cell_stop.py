"""A stop brings every robot to rest, whatever hangs: a goal's handler, another robot, the stop's own caller."""

from __future__ import annotations

import asyncio
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
import pytest

import engine.cell.open_cell
from engine.bus import ActiveGoal, GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.errors import RobotError
from engine.messages import Message
from engine.registry import load_factory
from engine.robot import DeviceStatus
from engine.skill import Action
from engine.skills.gripper import GripperMove
from engine.skills.motion import JointTrapVel
from robots.port import Tolerance
from robots.sim.world.sim_world import SimWorld
from tests.robots.panda_arm import home
from tests.robots.sim.demo_cell import joint_state, opened_cell, speed_rad_s
from tests.robots.sim.sim_cell import smooth, until

AWAY = JointTrapVel(joints=(0.5, -0.5, 0.0, -2.2, 0.0, 1.7, 0.8), speed=0.5)
REST_RAD_S = 0.02


class Nothing(Message, frozen=True, kw_only=True):
    """No more to say."""


class Hang(Action[Nothing, Nothing], frozen=True, kw_only=True):
    """Move the left arm and never come back."""


class HangingServer:
    """Carries out `Hang`: it moves the arm past its server, ignores its cancel, and ends when it is let go."""

    def __init__(self, world: SimWorld) -> None:
        self._world = world
        self.let_go = asyncio.Event()

    async def hang(self, goal: Hang, handle: ActiveGoal[Nothing]) -> Nothing:
        """Start the arm and wait for ever."""
        handle.accept()
        handle.on_cancel(lambda: None)
        self._world.arm("left").follow(smooth(home(), home() + 0.5, 3.0), tolerance=Tolerance())
        while not self.let_go.is_set():
            try:
                await self.let_go.wait()
            except asyncio.CancelledError:
                # This is what makes it hang: not even the end of its task ends it.
                continue
        return Nothing()


class HungRobot:
    """A robot whose stop never ends; implements `engine.robot.Robot`."""

    name = "hung"
    status = DeviceStatus.MOVING

    def register(self, bus: SkillBus) -> None:
        """It has no skills."""

    async def stop(self) -> None:
        """Wait for ever."""
        await asyncio.Event().wait()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing to close."""


@pytest.fixture
def worlds(monkeypatch: pytest.MonkeyPatch) -> list[SimWorld]:
    """The worlds of the cells that are opened, as they come."""
    made: list[SimWorld] = []

    def recorded(group: str, kind: str) -> Any:
        maker = load_factory(group, kind)

        def make(*args: Any, **options: Any) -> Any:
            made.append(maker(*args, **options))
            return made[-1]

        return make

    monkeypatch.setattr(engine.cell.open_cell, "load_factory", recorded)
    return made


async def hanging(cell: OpenCell, worlds: list[SimWorld]) -> HangingServer:
    """Send a goal whose handler hangs; return its server once the arm moves."""
    server = HangingServer(worlds[-1])
    cell.bus.advertise_action(Hang, server.hang, namespace="left")
    cell.bus.send_goal(Hang(), to="left")
    await until(lambda: speed_rad_s(cell.bus) > 0.1)
    return server


@pytest.mark.virtual
async def test_a_handler_that_hangs_keeps_no_robot_from_coming_to_rest(tmp_path: Path, worlds: list[SimWorld]) -> None:
    async with opened_cell(tmp_path) as cell:
        server = await hanging(cell, worlds)
        arm = cell.bus.send_goal(AWAY, to="right")
        fingers = cell.bus.send_goal(GripperMove(width_m=0.0, speed_m_s=0.02), to="right/gripper")
        await until(lambda: speed_rad_s(cell.bus, "right") > 0.1)
        started_s = cell.bus.clock.now_s()
        await cell.stop()
        assert cell.bus.clock.now_s() - started_s < 1.0
        assert max(speed_rad_s(cell.bus, name) for name in ("left", "right")) < REST_RAD_S
        assert [robot.status for robot in cell.robots.values()] == [DeviceStatus.READY] * 2
        assert [(await goal.result()).status for goal in (arm, fingers)] == [GoalStatus.CANCELED] * 2
        await until(lambda: len(cell.bus.goals()) == 1)
        (hung,) = cell.bus.goals()
        assert (hung.address, hung.status) == ("left/hang", GoalStatus.CANCELING)
        server.let_go.set()


@pytest.mark.virtual
async def test_after_a_stop_the_robots_take_goals_again(tmp_path: Path) -> None:
    """Also one whose goal had been sent and not yet begun."""
    async with opened_cell(tmp_path) as cell:
        late = cell.bus.send_goal(AWAY, to="left")
        await cell.stop()
        assert (await late.result()).status is GoalStatus.CANCELED
        assert np.abs(np.array(joint_state(cell.bus).position_rad) - home()).max() < 2e-3
        assert (await cell.bus.send_goal(AWAY, to="left").result()).status is GoalStatus.SUCCEEDED
        await cell.stop()


@pytest.mark.virtual
async def test_a_robot_that_does_not_confirm_is_named_and_the_others_rest(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        cell.robots = {"hung": HungRobot(), **cell.robots}
        cell.bus.send_goal(AWAY, to="left")
        await until(lambda: speed_rad_s(cell.bus) > 0.1)
        with pytest.raises(RobotError, match=r"hung: the device did not confirm rest within 10 s.*emergency stop"):
            await cell.stop()
        assert speed_rad_s(cell.bus) < REST_RAD_S


@pytest.mark.virtual
async def test_a_stop_whose_caller_is_cancelled_is_carried_through(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        cell.bus.send_goal(AWAY, to="left")
        await until(lambda: speed_rad_s(cell.bus) > 0.1)
        stopping = asyncio.create_task(cell.stop())
        await asyncio.sleep(0)
        stopping.cancel()
        await asyncio.wait((stopping,))
        assert (stopping.cancelled(), speed_rad_s(cell.bus) < REST_RAD_S) == (True, True)


@pytest.mark.virtual
async def test_a_cell_closes_though_a_handler_hangs(
    tmp_path: Path, worlds: list[SimWorld], caplog: pytest.LogCaptureFixture
) -> None:
    """The robots are at rest; the log names the handler."""
    async with opened_cell(tmp_path) as cell:
        server = await hanging(cell, worlds)
        bus, world = cell.bus, worlds[-1]
    assert np.abs(world.arm("left").sample().velocity_rad_s).max() < REST_RAD_S
    assert world.status is DeviceStatus.DISCONNECTED
    assert "the handler of left/hang does not end" in caplog.text
    server.let_go.set()
    for goal in bus.goals():
        await goal.result()

"""Separation monitoring of a cell: cameras measure a person, and motions that look at nothing stop before her."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from engine.bus import GoalHandle, GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import Cell, load_cell
from engine.messages import JointState
from engine.messages.separation import SeparationState
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import JointMotionFeedback, JointMotionResult, JointTrapVel
from engine.skills.people import CountContacts, Reach
from engine.skills.simulated_world import CameraFault, SetCameraFault

CELL = load_cell(Path(__file__).parent / "separated_cell.yaml")
UNMONITORED = replace(CELL, document=msgspec.structs.replace(CELL.document, speed_and_separation_monitoring=None))
START = (-0.9, 0.0, 0.0, -1.8, 0.0, 1.8, 0.8)
GOAL = (0.9, 0.0, 0.0, -1.8, 0.0, 1.8, 0.8)
# Where the hand of the arm passes before its goal.
IN_THE_PATH = (-0.02, 0.3, 0.45)
_REST_RAD_S = 0.01

Goal = GoalHandle[JointMotionResult, JointMotionFeedback]
pytestmark = pytest.mark.virtual


class SeparatedCell:
    """The open cell."""

    def __init__(self, bus: SkillBus) -> None:
        self.bus = bus

    @property
    def state(self) -> SeparationState:
        """What monitoring permits."""
        state = self.bus.topic("left/separation", SeparationState).latest
        assert state is not None
        return state

    @property
    def speed_rad_s(self) -> float:
        """The speed of the fastest joint."""
        state = self.bus.topic("left/joint_state", JointState).latest
        assert state is not None
        return max(map(abs, state.velocity_rad_s))

    def move(self, joints: tuple[float, ...]) -> Goal:
        """Start a motion that does not look out by itself."""
        return self.bus.send_goal(
            JointTrapVel(joints=joints, speed=0.4, collisions=CollisionOptions(avoid=False)), to="left"
        )

    async def until(self, condition: Callable[[], bool], *, within_s: float = 10.0) -> None:
        """Let time pass until a condition holds."""
        end_s = self.bus.clock.now_s() + within_s
        while not condition():
            assert self.bus.clock.now_s() < end_s, self.state
            await self.bus.clock.sleep(0.02)


@asynccontextmanager
async def opened_cell(folder: Path, document: Cell = CELL) -> AsyncGenerator[SeparatedCell]:
    """Open a cell with a store of its own."""
    async with OpenCell(document, store_path=str(folder / "store.db")) as cell:
        yield SeparatedCell(cell.bus)


async def test_who_reaches_into_the_path_is_met_by_an_arm_at_rest_that_goes_on_afterwards(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        assert (await cell.move(START).result()).status is GoalStatus.SUCCEEDED
        handle = cell.move(GOAL)
        await cell.until(lambda: cell.speed_rad_s > 0.2)
        await cell.bus.call(Reach(person="anna", hand_m=IN_THE_PATH, speed_m_s=1.2, stay_s=1.5), to="cell")
        await cell.until(lambda: cell.state.permitted_share == 0.0)
        assert cell.state.monitoring
        assert cell.state.nearest.startswith("left/")
        await cell.until(lambda: cell.speed_rad_s < _REST_RAD_S, within_s=0.5)
        touched = await cell.bus.call(CountContacts(person="anna"), to="cell")
        assert touched.contacts == 0
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        await cell.until(lambda: not cell.state.monitoring, within_s=0.2)


async def test_without_monitoring_the_same_reach_is_run_into(tmp_path: Path) -> None:
    async with opened_cell(tmp_path, UNMONITORED) as cell:
        await cell.move(START).result()
        handle = cell.move(GOAL)
        await cell.until(lambda: cell.speed_rad_s > 0.2)
        await cell.bus.call(Reach(person="anna", hand_m=IN_THE_PATH, speed_m_s=1.2, stay_s=1.5), to="cell")
        await handle.result()
        assert (await cell.bus.call(CountContacts(person="anna"), to="cell")).contacts > 0


async def test_a_covered_camera_stops_the_arm_with_the_reason(tmp_path: Path) -> None:
    async with opened_cell(tmp_path) as cell:
        await cell.move(START).result()
        handle = cell.move(GOAL)
        await cell.until(lambda: cell.speed_rad_s > 0.2)
        await cell.bus.call(SetCameraFault(camera="side", fault=CameraFault(kind="covered")), to="cell")
        await cell.until(lambda: bool(cell.state.reason), within_s=0.3)
        assert "side is covered" in cell.state.reason
        await cell.until(lambda: cell.speed_rad_s < _REST_RAD_S, within_s=1.0)
        await cell.bus.call(SetCameraFault(camera="side", fault=CameraFault()), to="cell")
        assert (await handle.result()).status is GoalStatus.SUCCEEDED

"""The demo cell of two Pandas, or another one, in virtual time, and its left arm moving around what is put into it."""

from __future__ import annotations

import asyncio
import dataclasses
from collections.abc import AsyncGenerator, Callable, Collection
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from msgspec.structs import replace

from engine.bus import GoalHandle, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import MujocoWorld, load_cell
from engine.messages import FramePoses, JointState, Pose, Vector3
from engine.messages.shapes import Box, Obstacle
from engine.skills.planning import (
    Adaptation,
    FreeMotionFeedback,
    FreeMotionResult,
    MotionTarget,
    MoveFree,
    PathPreview,
    PlanOptions,
)
from engine.skills.planning_scene import PutObstacle, RemoveObstacle
from robots.planning.request import PathCheck, PathCheckRequest
from robots.planning.scene.exact_checker import ExactChecker
from robots.port import Array
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.world.sim_world import SimWorld
from robots.workspace.workspace import Workspace
from tests.robots.sim.sim_cell import PATIENT_S

CELLS = Path(__file__).parents[3] / "behaviors" / "cells"
THERE = (0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)
ACROSS = (-0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)
REST_RAD_S = 0.02


def box(name: str, size_m: Vector3, xyz: Vector3) -> Obstacle:
    """Return a box along the world's axes."""
    return Obstacle.of(name, Box(size_m=size_m), Pose(xyz=xyz))


POST = box("post", (0.1, 0.1, 0.7), (-0.05, 0.1, 0.4))
"""In the way of the left arm from THERE to ACROSS; there is a way around it."""

WALL = box("wall", (1.5, 0.02, 2.6), (-0.05, 0.0, 1.0))
"""Nothing of the left arm gets from THERE to ACROSS past it."""


@dataclass
class FreeCell:
    """The open cell."""

    cell: OpenCell
    told: list[FreeMotionFeedback] = field(default_factory=list[FreeMotionFeedback])

    @property
    def bus(self) -> SkillBus:
        """Its bus."""
        return self.cell.bus

    @property
    def world(self) -> SimWorld:
        """Its world."""
        assert isinstance(self.cell.world, SimWorld)
        return self.cell.world

    @property
    def workspace(self) -> Workspace:
        """Its workspace."""
        (found,) = (device for device in self.world.devices() if isinstance(device, Workspace))
        return found

    def joints(self, arm: str = "left") -> Array:
        """Return the measured joints of an arm."""
        state = self.bus.topic(f"{arm}/joint_state", JointState).latest
        assert state is not None
        return np.array(state.position_rad)

    def speed_rad_s(self, arm: str = "left") -> float:
        """Return the speed of an arm's fastest joint."""
        state = self.bus.topic(f"{arm}/joint_state", JointState).latest
        assert state is not None
        return max(map(abs, state.velocity_rad_s))

    def send(self, goal: MoveFree, *, to: str = "left") -> GoalHandle[FreeMotionResult, FreeMotionFeedback]:
        """Send a goal and keep its feedback."""
        handle = self.bus.send_goal(goal, to=to)
        handle.on_feedback(self.told.append)
        return handle

    async def go(self, joints: tuple[float, ...], *, to: str = "left", **options: Any) -> FreeMotionResult:
        """Move free to `joints` and return the result of that."""
        end = await self.bus.send_goal(free(joints, **options), to=to).result()
        assert end.result is not None, end.cause
        return end.result

    async def put(self, obstacle: Obstacle) -> None:
        """Put an obstacle."""
        await self.bus.call(PutObstacle(obstacle=obstacle), to="cell")

    async def remove(self, name: str) -> None:
        """Remove an obstacle."""
        await self.bus.call(RemoveObstacle(name=name), to="cell")

    async def until(self, condition: Callable[[], bool], *, within_s: float = 10.0) -> None:
        """Return once `condition` holds."""
        async with asyncio.timeout(within_s):
            # What is measured tells nobody that it has changed: it can only be looked at.
            while not condition():
                await self.bus.clock.sleep(0.002)

    async def until_phase(self, phase: str, *, within_s: float = 10.0) -> FreeMotionFeedback:
        """Return the feedback that tells of a phase, as soon as it is there."""
        await self.until(lambda: bool(self.told) and self.told[-1].phase == phase, within_s=within_s)
        return self.told[-1]

    def touching(self, arm: str = "left") -> str:
        """Say what an arm touches in the physics."""
        host = self.world.host
        assert isinstance(host, LockstepHost)
        return host.simulation.touching(arm)

    def tool_xyz(self, arm: str = "left") -> Vector3:
        """Return where the tool is, in the world."""
        frames = self.bus.topic("cell/frames", FramePoses).latest
        assert frames is not None
        return frames.xyz[frames.names.index(f"{arm}/panda_hand_tcp")]

    def ahead(self, share: float, *, arm: str = "left") -> Vector3:
        """Return where the tool will be after a share of the way that is shown, in the world."""
        shown = self.bus.topic(f"{arm}/planned_path", PathPreview).latest
        assert shown is not None
        return shown.tool_path[int(share * (len(shown.tool_path) - 1))]

    def phases(self) -> list[str]:
        """Return the phases that were told, each once in a row."""
        found: list[str] = []
        for message in self.told:
            if not found or found[-1] != message.phase:
                found.append(message.phase)
        return found


def free(
    joints: tuple[float, ...], *, speed: float = 0.5, watch: bool = True, patience_s: float = 60.0, **options: Any
) -> MoveFree:
    """Return the goal to go to `joints`."""
    return MoveFree(
        target=MotionTarget(joints=joints),
        options=PlanOptions(speed=speed, **options),
        adaptation=Adaptation(watch=watch, patience_s=patience_s),
    )


@asynccontextmanager
async def free_cell(
    folder: Path, *, cell: str | Path = "dual_panda.yaml", arms: Collection[str] = ()
) -> AsyncGenerator[FreeCell]:
    """Open a cell with a store of its own, patient with an engine that a busy machine keeps waiting.

    Only with some of its arms where `arms` names them: in real time each takes a fifth of a processor.
    """
    loaded = load_cell(CELLS / cell)
    world = loaded.document.world
    assert isinstance(world, MujocoWorld)
    patient = replace(world, engine_silence_s=PATIENT_S, world_silence_s=PATIENT_S)
    robots = {name: robot for name, robot in loaded.document.robots.items() if not arms or name in arms}
    document = replace(loaded.document, world=patient, robots=robots)
    patient_cell = dataclasses.replace(loaded, document=document)
    async with OpenCell(patient_cell, store_path=str(folder / "store.db")) as opened:
        yield FreeCell(opened)


def put_after_the_check(opened: FreeCell, obstacle: Obstacle, monkeypatch: pytest.MonkeyPatch) -> None:
    """Put an obstacle when the path of the next motion has been checked, before the motion has begun."""
    planners = opened.workspace.planners
    check = planners.check_path

    async def check_then_put(request: PathCheckRequest) -> PathCheck:
        answer = await check(request)
        monkeypatch.setattr(planners, "check_path", check)
        await opened.put(obstacle)
        return answer

    monkeypatch.setattr(planners, "check_path", check_then_put)


class Witness:
    """Looks every 5 ms at what the left arm touches of a scene as it is then, exactly."""

    def __init__(self, opened: FreeCell, *obstacles: Obstacle, arm: str = "left") -> None:
        self._opened = opened
        self._obstacles = obstacles
        self._arm = arm
        self.touched: set[tuple[str, str]] = set()
        self.looks = 0
        self._task = asyncio.create_task(self._look(), name="witness")

    async def end(self) -> None:
        """Look no more."""
        self._task.cancel()
        await asyncio.wait((self._task,))

    async def _look(self) -> None:
        checker = ExactChecker(self._opened.workspace.scene_for(self._arm).with_obstacles(*self._obstacles), self._arm)
        while True:
            self.touched.update(checker.colliding_pairs(self._opened.joints(self._arm)))
            self.looks += 1
            await self._opened.bus.clock.sleep(0.005)

"""Each drag of the handle in the 3D view moves the tool its way, however short it is: by logs of the pose."""

from __future__ import annotations

import asyncio
import random
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, cast

import numpy as np
import pytest

from editor_web.cell_view import CellView, DragHandle, HandlePull
from editor_web.cell_view.rendering.transforms import WorldPose
from editor_web.teaching.handle_drag import HandleDrag, HandleStatus, ShowHandle
from editor_web.teaching.jogging import Jogger
from editor_web.teaching.teaching_messages import RefusedFrame
from engine.bus.json_bus import LocalJsonBus
from engine.messages import FramePoses, RobotDescription
from engine.project import Session
from robots.port import Array
from tests.editor_web.teaching.jogged_arm import Jogged, follow
from tests.robots.panda_arm import BASE, panda_kinematics
from tests.robots.workspace.fake_cell import FakeCell, fake_cell

DRAGS, SEED = 100, 11
HOLDS_S = (0.0, 0.02, 0.09)
FAR_M = 0.03
STRAIGHT = 0.99


class HandleView:
    """A 3D view with at most one handle."""

    def __init__(self) -> None:
        self.handle: DragHandle | None = None

    def give_handle(self, page: str, handle: DragHandle) -> None:
        self.handle = handle

    def take_handle(self, page: str, handle: DragHandle) -> None:
        self.handle = None


class Seen:
    """What the page's server knows of the cell: the description of its arm, and where its tool is."""

    def __init__(self, cell: FakeCell) -> None:
        self.bus = LocalJsonBus(cell.bus)
        self._cell = cell
        description = cell.bus.find_topic("left/description").latest
        assert isinstance(description, RobotDescription)
        self._description = description

    def tool(self) -> WorldPose:
        pose = BASE.then(panda_kinematics().tool_pose(self._cell.port.sample().position_rad)).to_pose("world")
        return WorldPose(xyz=pose.xyz, xyzw=pose.xyzw)

    def latest(self, topic: str) -> Any:
        if topic == "left/description":
            return self._description
        now = self.tool()
        return FramePoses(time_s=0.0, names=(self._description.tool_frame,), xyz=(now.xyz,), xyzw=(now.xyzw,))


@dataclass
class Hand:
    """A mouse at the handle of a page."""

    arm: Jogged
    seen: Seen
    view: HandleView
    drag: HandleDrag
    told: list[HandleStatus | RefusedFrame]

    async def pull(self, way_m: Array, *, hold_s: float = 0.0, keeps_alive: bool = True) -> None:
        """Drag the handle by so much, in the world, and let go."""
        handle, now = self.view.handle, self.seen.tool()
        assert handle is not None
        x, y, z = np.add(now.xyz, way_m).tolist()
        if keeps_alive:
            self.drag.held()
        handle.pulled(HandlePull(phase="start", pose=now))
        target = WorldPose(xyz=(x, y, z), xyzw=now.xyzw)
        handle.pulled(HandlePull(phase="update", pose=target))
        await self.arm.wait(hold_s)
        handle.pulled(HandlePull(phase="end", pose=target))

    @property
    def refusals(self) -> list[str]:
        return [message.message for message in self.told if isinstance(message, RefusedFrame)]


@asynccontextmanager
async def hand_at_handle() -> AsyncGenerator[Hand]:
    async with fake_cell() as cell:
        seen, view = Seen(cell), HandleView()
        told: list[HandleStatus | RefusedFrame] = []
        drag = HandleDrag(cast("Session", seen), cast("CellView", view), "page", joggers={}, send=told.append)
        arm = Jogged(
            cell, Jogger(seen.bus, taken={}, send=lambda _: None), [], [cell.port.sample().position_rad.copy()], []
        )
        moving = asyncio.create_task(follow(arm))
        await drag.take(ShowHandle(arm="left"))
        try:
            yield Hand(arm, seen, view, drag, told)
        finally:
            await drag.close()
            moving.cancel()


def any_pull(random_: random.Random) -> Array:
    """A way of the handle that is no shorter than what a hand does, along one of the axes."""
    way = np.zeros(3)
    way[random_.randrange(3)] = random_.choice((1.0, -1.0)) * FAR_M
    return way


def moved(arm: Jogged, since: int) -> Array:
    """Return how the tool has moved since a place in the log, in the world."""
    first, last = (BASE.then(panda_kinematics().tool_pose(arm.log[k])).xyz for k in (since, -1))
    return last - first


@pytest.mark.virtual
async def test_none_of_a_hundred_changes_of_direction_by_the_handle_is_lost() -> None:
    """There and back, each drag let go at once or soon; the arm goes the way of the drag and no other."""
    random_ = random.Random(SEED)
    ways = [sign * way for way in (any_pull(random_) for _ in range(DRAGS // 2)) for sign in (1.0, -1.0)]
    wrong: list[tuple[int, Array]] = []
    async with hand_at_handle() as hand:
        for k, way in enumerate(ways):
            before = len(hand.arm.log) - 1
            await hand.pull(way, hold_s=random_.choice(HOLDS_S))
            await hand.arm.wait(0.35)
            gone = moved(hand.arm, before)
            length = float(np.linalg.norm(gone))
            if length < 0.002 or float(gone @ way) < STRAIGHT * length * FAR_M:
                wrong.append((k, gone))
        assert (hand.refusals, wrong) == ([], [])
        assert all(float(np.abs(after - before).max()) < 0.01 for before, after in pairwise(hand.arm.log))


@pytest.mark.virtual
async def test_a_drag_that_nobody_holds_moves_nothing_and_says_so() -> None:
    """What viser says does not do; the page has to say that its mouse is down."""
    async with hand_at_handle() as hand:
        await hand.pull(np.array((FAR_M, 0.0, 0.0)), hold_s=0.1, keeps_alive=False)
        await hand.arm.wait(0.5)
        assert (len(hand.arm.log), hand.told[-1]) == (1, HandleStatus(arm="left", mode="move", pulled=False))
        assert hand.refusals == ["the drag has moved nothing: it was over before the arm could follow"]


@pytest.mark.virtual
async def test_a_drag_whose_page_falls_silent_is_broken_off() -> None:
    """The mouse is still down, as far as the 3D view knows."""
    async with hand_at_handle() as hand:
        handle, now = hand.view.handle, hand.seen.tool()
        assert handle is not None
        hand.drag.held()
        target = WorldPose(xyz=(now.xyz[0], now.xyz[1], now.xyz[2] + 10 * FAR_M), xyzw=now.xyzw)
        handle.pulled(HandlePull(phase="start", pose=target))
        await hand.arm.wait(0.2)
        assert len(hand.arm.log) > 1
        await hand.arm.wait(0.5)
        assert hand.arm.moved_s[-1] < hand.arm.cell.bus.clock.now_s() - 0.3
        assert hand.arm.cell.bus.goals() == ()

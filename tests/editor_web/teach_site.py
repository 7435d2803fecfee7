"""A simulated arm that is taught over a served page, in a thread of its own and in real time."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any, Self, TypeVar
from unittest.mock import patch

import numpy as np
import websockets.asyncio.client

from editor_web.security.authentication import OPERATOR, AccessTokens, Role, load_access_tokens
from editor_web.security.middleware import cookie_name
from editor_web.server import Dashboard, dashboard
from editor_web.teaching import jogging
from engine.bus import SkillBus
from engine.bus.json_bus import CLI_HOLDER
from engine.cell.open_cell import OpenCell
from engine.document.cell import Cell, load_cell
from engine.journal import Journal
from engine.messages import JointState
from engine.project.session import Session
from engine.registry import load_states
from engine.skills.entries import WriteEntry
from engine.skills.jogging import JogCommand, StepTool
from engine.skills.motion import JointTrapVel
from engine.skills.teaching import Trigger
from engine.teaching import HelpingHand, guidable_robots
from robots.port import Array
from tests.editor_web.limits import GUARD_S
from tests.robots.panda_arm import home

T = TypeVar("T")
RESTS_RAD_S = 0.01
"""A joint that is slower than this rests."""
UP_S = 4 * GUARD_S

CELL = """\
flexcell: 1
cell: taught
store: {kind: sqlite, path: cell.db}
world: {kind: mujoco, step_s: 0.002, engine_silence_s: 20, world_silence_s: 20}
robots:
  left:
    model: panda
    driver: sim
    base: {xyz: [-0.55, 0.0, 0.0]}
    gripper: {model: panda_hand}
fixtures:
  table: {shape: box, size_m: [1.6, 1.2, 0.04], at: {xyz: [0, 0, -0.02]}}
"""


def fastest(state: JointState) -> float:
    """Return the speed of the fastest joint."""
    return max(map(abs, state.velocity_rad_s))


class TeachSite:
    """`with TeachSite(…) as site`: the page is at `site.running.url`; the arm stands at home.

    The arm rests whenever it hears nothing for the time of its watchdog. Only what is beyond that is longer here than
    elsewhere: a page that a busy machine keeps from speaking for a second has not let go of its arm for good.
    """

    def __init__(
        self,
        *,
        host: str,
        project: Path,
        triggers: tuple[Trigger, ...] = (),
        view: bool = False,
        cell: Cell | None = None,
        warm: bool = True,
    ) -> None:
        self.project = project
        self._host, self._triggers, self._view, self._warm = host, triggers, view, warm
        self.loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self.loop.run_forever, name="teach site")
        self._open = AsyncExitStack()
        self._parts: tuple[OpenCell, Session, Dashboard] | None = None
        (project / "behaviors" / "cells").mkdir(parents=True, exist_ok=True)
        (project / "behaviors" / "cells" / "taught.yaml").write_text(CELL, encoding="utf-8")
        self._cell = cell

    @property
    def bus(self) -> SkillBus:
        """The cell's bus; call it on the loop."""
        assert self._parts is not None
        return self._parts[0].bus

    @property
    def session(self) -> Session:
        """The engine."""
        assert self._parts is not None
        return self._parts[1]

    @property
    def running(self) -> Dashboard:
        """The server."""
        assert self._parts is not None
        return self._parts[2]

    @property
    def access(self) -> AccessTokens:
        """Its tokens."""
        return load_access_tokens(self.project / "tokens")

    def call(self, work: Coroutine[Any, Any, T], *, within_s: float = GUARD_S) -> T:
        """Run a coroutine on the server's loop."""
        return asyncio.run_coroutine_threadsafe(work, self.loop).result(timeout=within_s)

    def on_loop(self, work: Callable[[], T]) -> T:
        """Call a function on the server's loop."""

        async def called() -> T:
            return work()

        return self.call(called())

    def joints(self) -> JointState:
        """What is measured now."""
        latest = self.on_loop(lambda: self.bus.find_topic("left/joint_state").latest)
        assert isinstance(latest, JointState)
        return latest

    async def seen(self, condition: Callable[[JointState], bool]) -> JointState:
        """Wait, on any loop, for a measurement."""
        return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(self._until(condition), self.loop))

    async def _until(self, condition: Callable[[JointState], bool], *, within_s: float = GUARD_S) -> JointState:
        topic = self.bus.find_topic("left/joint_state")
        async with asyncio.timeout(within_s):
            with topic.stream() as stream:
                while True:
                    state = await stream.next()
                    if condition(state):
                        return state

    async def moved(self, began: Array, *, by_rad: float) -> JointState:
        """Wait until a joint is so far from where it was."""
        return await self.seen(lambda state: float(np.abs(np.subtract(state.position_rad, began)).max()) > by_rad)

    async def rested(self) -> JointState:
        """Wait until no joint moves for a tenth of a second, and return the first measurement of that."""
        rests: list[JointState] = []

        def is_still(state: JointState) -> bool:
            if fastest(state) >= RESTS_RAD_S:
                rests.clear()
            else:
                rests.append(state)
            return bool(rests) and state.time_s > rests[0].time_s + 0.1

        await self.seen(is_still)
        return rests[0]

    async def last_moving(self) -> JointState:
        """Wait until the arm rests, and return the last measurement in which a joint moved.

        A busy machine looks less often; so nothing is taken for motion that nobody has seen.
        """
        moving: list[JointState] = []

        def is_still(state: JointState) -> bool:
            if fastest(state) >= RESTS_RAD_S or not moving:
                moving.append(state)
            return state.time_s > moving[-1].time_s + 0.1

        await self.seen(is_still)
        return moving[-1]

    async def let_go(self) -> None:
        """Wait until no goal is under way: a page that is gone is missed a moment after the arm rests."""
        for goal in self.bus.goals():
            await goal.result()

    async def hear_jogs(self) -> list[float]:
        """Return a list that gets the time of the simulated world of every command that moves the arm."""
        state = self.bus.find_topic("left/joint_state")
        told_s: list[float] = []

        def take(command: JogCommand) -> None:
            if any(command.velocity) and isinstance(state.latest, JointState):
                told_s.append(state.latest.time_s)

        self.bus.topic("left/jog", JogCommand).subscribe(take)
        return told_s

    async def write_joints(self, name: str, joints: tuple[float, ...], *, tags: tuple[str, ...] = ()) -> None:
        """Write an entry."""
        await self.bus.call(WriteEntry(kind="joints", name=name, value={"joints": joints}, tags=tags), to="store")

    async def go_home(self) -> None:
        """Move the arm to where it begins."""
        await self.turn(0.0)

    async def turn(self, by_rad: float) -> None:
        """Move the arm to where it begins, its first joint so far from there."""
        joints = home().tolist()
        goal = JointTrapVel(joints=(joints[0] + by_rad, *joints[1:]), speed=0.9)
        await self.bus.send_goal(goal, to="left", holder=CLI_HOLDER).result()
        self.bus.leases.release_run(CLI_HOLDER.run)

    def socket(self, role: Role = OPERATOR, *, page: str = "") -> websockets.asyncio.client.connect:
        """Connect as the page does, which calls itself so."""
        origin = self.running.url.rstrip("/")
        return websockets.asyncio.client.connect(
            f"{origin.replace('http', 'ws', 1)}/api/v1/teach/live?page={page}",
            additional_headers={"Cookie": f"{cookie_name(self.running.port)}={self.running.sessions.begin(role)}"},
            origin=websockets.Origin(origin),
            compression=None,
            proxy=None,
        )

    def __enter__(self) -> Self:
        self._open.enter_context(patch.object(jogging, "IDLE_S", GUARD_S))
        self._thread.start()
        try:
            # A world and its planners that start while others do take minutes on a busy machine.
            self.call(self._up(), within_s=UP_S)
        except BaseException:
            # A thread that goes on would keep the tests from ever ending.
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.call(self._open.aclose())
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join()
        self.loop.close()

    async def _up(self) -> None:
        enter = self._open.enter_async_context
        journal = self._open.enter_context(Journal.open(self.project / ".flexcell"))
        document = self._cell or load_cell(self.project / "behaviors" / "cells" / "taught.yaml")
        cell = OpenCell(document, store_path=str(self.project / "cell.db"))
        await enter(cell)
        hand = HelpingHand(
            cell.bus,
            robots=guidable_robots(cell.bus),
            folder=self.project / "captures",
            triggers=self._triggers,
            file=self.project / "triggers.yaml",
        )
        await enter(hand)
        session = await enter(Session(cell, project=self.project, catalogue=load_states(), journal=journal))
        running = await enter(
            dashboard(session, token_file=self.project / "tokens", host=self._host, cell_view=self._view, shadows=False)
        )
        self._parts = cell, session, running
        if not self._warm:
            return
        # The first step loads what looks ahead of the arm.
        await self.bus.send_goal(StepTool(step_m=(0.0, 0.0, 0.005)), to="left", holder=CLI_HOLDER).result()
        await self.go_home()

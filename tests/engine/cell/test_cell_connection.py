"""A cell whose world is lost says so, refuses runs that need it, and is connected again by command."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pytest

import engine.cell.open_cell
from engine.bus import Holder, SkillBus
from engine.cell.cell_connection import CellConnection
from engine.cell.open_cell import OpenCell
from engine.document.cell import Cell, load_cell
from engine.errors import ControlError, RobotError
from engine.journal import Journal, list_runs
from engine.project.session import Session
from engine.robot import DeviceStatus, Robot
from tests.engine.fake_states import CATALOGUE

WHY = "the world's process was ended by SIGKILL"
MOVES = """
flexcell: 1
name: {name}
outcomes: [done]
success: [done]
root:
  machine:
    initial: only
    states:
      only: {{state: {state}, transitions: {transitions}}}
"""


class FakeWorld:
    """A world that is lost when told, and comes back; implements `World` and `Reconnectable`."""

    name = "cell"
    status = DeviceStatus.READY

    def __init__(self) -> None:
        self.lost_reason = ""
        self.note = ""
        self.refusal = ""
        self.connects = 0
        self._tell: Callable[[], None] | None = None

    def robots(self) -> tuple[Robot, ...]:
        return ()

    def register(self, bus: SkillBus) -> None:
        """It has no skills."""

    def snapshot(self) -> bytes:
        return b"here"

    async def restore(self, snapshot: bytes) -> None:
        """Everything is where it was."""

    async def stop(self) -> None:
        """Nothing moves."""

    def when_connection_changes(self, callback: Callable[[], None]) -> None:
        self._tell = callback

    def lose(self) -> None:
        """Be lost from now on."""
        self.lost_reason = WHY
        self._notify()

    async def reconnect(self) -> str:
        await asyncio.sleep(0)
        self.connects += 1
        if self.refusal:
            raise RobotError(self.refusal)
        self.lost_reason = ""
        self._notify()
        return self.note

    def _notify(self) -> None:
        assert self._tell is not None
        self._tell()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing to close."""


@pytest.fixture
def world(monkeypatch: pytest.MonkeyPatch) -> FakeWorld:
    """The world of every cell that is opened."""
    made = FakeWorld()

    def load(group: str, kind: str) -> Any:
        return make

    def make(cell: Cell, *, bus: SkillBus, virtual: bool, seed: int | None, new_stop_line: object) -> FakeWorld:
        return made

    monkeypatch.setattr(engine.cell.open_cell, "load_factory", load)
    return made


@asynccontextmanager
async def opened(folder: Path) -> AsyncGenerator[OpenCell]:
    """Open a cell that consists of the fake world."""
    (folder / "cell.yaml").write_text("flexcell: 1\ncell: c\nworld: {kind: mujoco}\n", encoding="utf-8")
    async with OpenCell(load_cell(folder / "cell.yaml")) as cell:
        yield cell


@asynccontextmanager
async def session(folder: Path) -> AsyncGenerator[Session]:
    """Open a session with a behavior that commands a robot and one that commands nothing."""
    behaviors = folder / "behaviors"
    behaviors.mkdir()
    moves = MOVES.format(name="moves", state="test.Use, with: {for_s: 1}", transitions="{done: done}")
    waits = MOVES.format(name="waits", state="test.Give", transitions="{a: done, b: done, c: done}")
    (behaviors / "moves.yaml").write_text(moves, encoding="utf-8")
    (behaviors / "waits.yaml").write_text(waits, encoding="utf-8")
    with Journal.open(folder / "journal", inline=True) as journal:
        async with (
            opened(folder) as cell,
            Session(cell, project=folder, catalogue=CATALOGUE, journal=journal) as found,
        ):
            yield found


@pytest.mark.virtual
async def test_the_connection_is_published_on_the_bus_when_it_is_lost_and_when_it_is_back(
    tmp_path: Path, world: FakeWorld
) -> None:
    async with opened(tmp_path) as cell:
        told: list[CellConnection] = []
        topic = cell.bus.find_topic("cell/connection")
        assert topic.latest == CellConnection(connected=True)
        topic.subscribe(told.append)
        world.lose()
        assert cell.connection == CellConnection(connected=False, reason=WHY)
        await cell.reconnect()
    assert told == [CellConnection(connected=False, reason=WHY), CellConnection(connected=True)]


@pytest.mark.virtual
async def test_what_is_not_as_it_was_before_is_reported_of_a_cell_that_is_back(
    tmp_path: Path, world: FakeWorld
) -> None:
    async with opened(tmp_path) as cell:
        world.lose()
        world.note = "the world has begun anew"
        await cell.reconnect()
        assert cell.connection == CellConnection(connected=True, reason="the world has begun anew")


@pytest.mark.virtual
async def test_a_device_that_does_not_come_back_leaves_the_cell_lost(tmp_path: Path, world: FakeWorld) -> None:
    async with opened(tmp_path) as cell:
        world.lose()
        world.refusal = "the world's process does not start"
        with pytest.raises(RobotError, match="does not start"):
            await cell.reconnect()
        assert cell.connection == CellConnection(connected=False, reason=WHY)


@pytest.mark.virtual
async def test_a_cell_that_is_connected_or_is_being_connected_is_not_connected_twice(
    tmp_path: Path, world: FakeWorld
) -> None:
    async with opened(tmp_path) as cell:
        await cell.reconnect()
        world.lose()
        await asyncio.gather(cell.reconnect(), cell.reconnect())
        assert world.connects == 1


@pytest.mark.virtual
async def test_a_run_that_commands_robots_is_refused_with_the_reason_and_the_journal_knows_nothing_of_it(
    tmp_path: Path, world: FakeWorld
) -> None:
    async with session(tmp_path) as opened_session:
        world.lose()
        with pytest.raises(RobotError, match=r"SIGKILL.*`flexcell cell connect`"):
            await opened_session.start("behaviors/moves.yaml", parameters={}, seed=1)
        assert (opened_session.runs(), list_runs(tmp_path / "journal")) == ((), ())
        run = await opened_session.start("behaviors/waits.yaml", parameters={}, seed=1)
        assert (await opened_session.wait(run)).success
        await opened_session.connect_cell()
        run = await opened_session.start("behaviors/moves.yaml", parameters={}, seed=1)
        assert (await opened_session.wait(run)).success


@pytest.mark.virtual
async def test_a_cell_is_not_connected_under_a_run(tmp_path: Path, world: FakeWorld) -> None:
    async with session(tmp_path) as opened_session:
        run = await opened_session.start("behaviors/moves.yaml", parameters={}, seed=1)
        world.lose()
        with pytest.raises(ControlError, match="a run is active"):
            await opened_session.connect_cell()
        await opened_session.wait(run)
        await opened_session.connect_cell()
        assert opened_session.cell_connection == CellConnection(connected=True)


@pytest.mark.virtual
async def test_a_cell_is_not_connected_while_somebody_commands_a_robot_of_it(tmp_path: Path, world: FakeWorld) -> None:
    async with opened(tmp_path) as cell:
        cell.robots = {"left": world}
        cell.bus.leases.acquire(("left",), Holder("jog"))
        world.lose()
        with pytest.raises(ControlError, match="left is commanded by run jog"):
            await cell.reconnect()

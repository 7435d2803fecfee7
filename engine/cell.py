"""An open cell: its robots connected, its world running, its store and bus ready.

`async with OpenCell(...)` opens store, world and robots in that order and closes them in reverse,
bringing every robot to rest. It belongs to the event loop it is opened on.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from contextlib import AsyncExitStack
from types import TracebackType
from typing import Self

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.document.cell import Cell
from engine.document.entries import load_entries
from engine.errors import CellError, FlexcellError, RobotError
from engine.registry import DRIVERS, WORLDS, load_maker
from engine.robot import Robot, World
from engine.store import SqliteStore, Store, register_store

NewWorld = Callable[..., World]
NewRobot = Callable[..., Robot]


class OpenCell:
    """A cell document brought to life; without one, a bus with nothing on it.

    Args:
        cell: The document, or None for behaviors that need no robot.
        seed: Places the parts of a simulated world within their jitter; None exactly where they are drawn.
        store_path: Replaces the path of the store in the document.
    """

    def __init__(self, cell: Cell | None, *, seed: int | None = None, store_path: str | None = None) -> None:
        self.document = cell
        self.seed = seed
        self.bus = SkillBus(new_clock())
        self.store: Store | None = None
        self.robots: Mapping[str, Robot] = {}
        self._store_path = store_path
        self._stack = AsyncExitStack()

    @property
    def name(self) -> str:
        """The name of the cell, empty without a document."""
        return self.document.name if self.document is not None else ""

    async def __aenter__(self) -> Self:
        try:
            await self._open()
        except BaseException:
            # Whatever stopped the opening, what was opened so far must come to rest and close.
            await self._stack.aclose()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()

    async def stop(self) -> None:
        """Bring every robot to rest.

        Raises:
            RobotError: one could not confirm it; the others were stopped all the same.
        """
        ends = await asyncio.gather(*(robot.stop() for robot in self.robots.values()), return_exceptions=True)
        failures = [end for end in ends if isinstance(end, BaseException)]
        if failures:
            raise RobotError(
                "; ".join(str(failure) for failure in failures), where=self.name, hint="use the emergency stop"
            ) from failures[0]

    async def _open(self) -> None:
        if self.document is None:
            return
        await self._open_store(self.document)
        world = await self._open_world(self.document)
        await self._open_robots(self.document, world)
        await self._stack.enter_async_context(self.bus)

    async def _open_store(self, cell: Cell) -> None:
        if cell.document.store is None:
            return
        path = self._store_path or cell.document.store.path
        store = SqliteStore.open(path, inline=self.bus.clock.virtual)
        self.store = await self._stack.enter_async_context(store)
        if cell.seed_file is not None:
            await store.seed(load_entries(cell.seed_file).records())
        register_store(self.bus, store)

    async def _open_world(self, cell: Cell) -> World | None:
        if cell.document.world is None:
            return None
        new_world: NewWorld = load_maker(WORLDS, "mujoco")
        world = await self._stack.enter_async_context(
            new_world(cell, bus=self.bus, virtual=self.bus.clock.virtual, seed=self.seed)
        )
        world.register(self.bus)
        return world

    async def _open_robots(self, cell: Cell, world: World | None) -> None:
        simulated = {robot.name: robot for robot in world.robots()} if world is not None else {}
        robots: dict[str, Robot] = {}
        for name, entry in cell.document.robots.items():
            try:
                made = simulated[name] if entry.simulated else self._new_robot(cell, name, entry.driver_kind)
            except FlexcellError as error:
                raise CellError(error.message, where=f"robot {name} of {cell.file}", hint=error.hint) from error
            robot = await self._stack.enter_async_context(made)
            robot.register(self.bus)
            robots[name] = robot
        self.robots = robots

    def _new_robot(self, cell: Cell, name: str, kind: str) -> Robot:
        maker: NewRobot = load_maker(DRIVERS, kind)
        return maker(cell, name=name, bus=self.bus)

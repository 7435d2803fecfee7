"""An open cell: its robots connected, its world running, its store and bus ready.

`async with OpenCell(...)` opens store, world and robots in that order and closes them in reverse order,
bringing every robot to rest. It belongs to the event loop on which it is opened.
"""

from __future__ import annotations

import asyncio
import logging
from collections import ChainMap
from collections.abc import Callable, Mapping
from contextlib import AsyncExitStack, suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from engine.bus import SkillBus
from engine.cell.cell_connection import CellConnection, CellConnectionMonitor
from engine.cell.cell_store import open_cell_store, store_address
from engine.cell.cell_topics import open_topics
from engine.cell.drivers.device_context import DeviceContext
from engine.cell.drivers.driver_assignments import AssignedDriver, assigned_drivers
from engine.clock import new_clock
from engine.document.cell import Cell
from engine.document.entries_document import load_entries
from engine.errors import CellError, ControlError, DocumentError, FlexcellError, NotStopped, RobotError
from engine.measures import TopicMeasures
from engine.preemption import OverduePolicy, preempt
from engine.registry import WORLDS, load_factory
from engine.robot import MeasurePort, Robot, World
from engine.skills.devices import EnableDevice
from engine.stop import StopRelay
from engine.store import Store, publish_changes, register_store

_PATIENCE_S = 10.0
"""Time limit for a robot to come to rest, and for the handlers of goals to end."""

_log = logging.getLogger("flexcell.cell")

NewWorld = Callable[..., World]
DeviceStopped = Callable[[str, BaseException | None], None]
"""Receives the name of a device once its stop has ended, and why it did not confirm rest; None if it did."""


class OpenCell:
    """The open cell of a document; without a document, an empty bus.

    Args:
        cell: The document, or None for behaviors that need no robot.
        seed: Seed of the random part poses of a simulated world within their jitter; None for the nominal poses.
        store_path: Replaces the store of the document: a file, or the address of a MongoDB server.
        relay: Provides a stop line for every process that moves devices; without it, STOP needs the event loop.
        capture: Folder to which the bytes of all connections to real devices are captured; None for none.
    """

    def __init__(
        self,
        cell: Cell | None,
        *,
        seed: int | None = None,
        store_path: str | None = None,
        relay: StopRelay | None = None,
        capture: Path | None = None,
    ) -> None:
        self.document = cell
        self.seed = seed
        self.bus = SkillBus(new_clock(), service_timeout_s=cell.document.bus.service_timeout_s if cell else None)
        self.store: Store | None = None
        self.robots: Mapping[str, Robot] = {}
        self.tools: Mapping[str, Robot] = {}
        """The tools with a driver of their own, by bus namespace; all others are served by their arms."""
        self.equipment: Mapping[str, Robot] = {}
        """The equipment by name, simulated or with a driver."""
        self._equipped_devices: tuple[Robot, ...] = ()
        self._world: World | None = None
        self._real_arms = TopicMeasures(())
        self._store_path = store_path
        self.relay = relay
        self._capture = capture
        self._stack = AsyncExitStack()
        self._connections = CellConnectionMonitor(self.bus)

    @property
    def name(self) -> str:
        """The name of the cell, empty without a document."""
        return self.document.name if self.document is not None else ""

    @property
    def world(self) -> World | None:
        """The simulated world, once the cell is open; None without one."""
        return self._world

    @property
    def has_world(self) -> bool:
        """Whether there is a simulated world, whose state can be restored."""
        return self.document is not None and self.document.document.world is not None

    @property
    def store_path(self) -> str | None:
        """The file or address of the store, without secrets; None without a store."""
        return store_address(self.document, self._store_path) if self.document is not None else None

    @property
    def connection(self) -> CellConnection:
        """Whether every device is connected, and which are not."""
        return self._connections.now

    def require_connected(self) -> None:
        """Raise RobotError, naming the lost devices, unless every device is connected."""
        self._connections.require()

    async def reconnect(self) -> None:
        """Reconnect all lost devices under the same names; does nothing when all are connected.

        A simulated world continues from its last state, at rest.

        Raises:
            ControlError: a robot is commanded by a run.
            RobotError: a device cannot be reconnected.
        """
        for robot in self.robots:
            owner = self.bus.leases.owner(robot)
            if owner is not None and not self.connection.connected:
                raise ControlError(f"{robot} is commanded by run {owner}", where=self.name, hint="stop that run first")
        await self._connections.reconnect()

    async def enable(self, reason: str, *, by: str = "") -> None:
        """Permit motion of all real devices: the command of a person, who gives name and reason.

        Raises:
            FlexcellError: a device cannot move; the message names the cause.
        """
        skill = EnableDevice.skill_name()
        for address in self.bus.skills():
            device, _, name = address.rpartition("/")
            if name == skill:
                await self.bus.call(EnableDevice(reason=reason, by=by), to=device)

    async def __aenter__(self) -> Self:
        try:
            await self._open()
        except BaseException:
            # After any error, the devices opened so far must come to rest and close.
            await self._stack.aclose()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()

    @property
    def devices(self) -> tuple[Robot, ...]:
        """Everything that a stop brings to rest: robots, tools with a driver of their own, equipment, the world."""
        devices = (*self.robots.values(), *self.tools.values(), *self.equipment.values(), *self._equipped_devices)
        return (*devices, *((self._world,) if self._world is not None else ()))

    async def stop(self, *, ended: DeviceStopped | None = None) -> None:
        """Cancel every goal and bring every robot to rest, whether or not the goals' handlers end.

        Args:
            ended: Called for each device when its stop has ended.

        Raises:
            RobotError: a robot could not confirm rest; the others were stopped.
        """
        for goal in self.bus.goals():
            goal.cancel()
        stops = {asyncio.create_task(device.stop(), name=f"stop {device.name}"): device for device in self.devices}
        if ended is not None:
            for task, device in stops.items():
                task.add_done_callback(lambda task, device=device: ended(device.name, _failure(task, device)))
        await _wait_uncancelled(tuple(stops))
        failures = [failure for task, device in stops.items() if (failure := _failure(task, device)) is not None]
        if failures:
            raise RobotError(
                "; ".join(str(failure) for failure in failures), where=self.name, hint="use the emergency stop"
            ) from failures[0]

    def measures(self) -> dict[str, float]:
        """Return what the devices have summed up since the cell was opened, by name as in `engine.messages.measures`.

        Arms that are not simulated and sum up nothing themselves have what their topics tell.

        Raises:
            RobotError: a device is not connected.
        """
        # A world has the bodies of real arms too: what is measured of these arms counts more.
        devices = (self._world, self._real_arms, *self.robots.values(), *self.tools.values())
        ports = [device for device in devices if isinstance(device, MeasurePort)]
        return {name: value for port in ports for name, value in port.measures().items()}

    async def snapshot(self) -> bytes | None:
        """Return a snapshot of the world for `restore`; None without a world."""
        return self._world.snapshot() if self._world is not None else None

    async def restore(self, snapshot: bytes) -> None:
        """Restore the world to the state of `snapshot`, at rest; call it before the first goal.

        Raises:
            CellError: this cell has no world.
            RobotError: something moves, or the snapshot is not of this world.
        """
        if self._world is None:
            raise CellError("the cell has no world to restore", where=self.name, hint="open the cell of the snapshot")
        await self._world.restore(snapshot)

    async def _open(self) -> None:
        if self.document is None:
            self._stack.push_async_callback(self._close_bus)
            return
        open_topics(self.bus, self.document.document)
        await self._open_store(self.document)
        if self.relay is not None:
            # Before the devices, which get new lines from the relay when all are reconnected.
            self._connections.follow(self.relay)
        world = await self._open_world(self.document)
        driven = {each.written_name: each for each in assigned_drivers(self.document)}
        await self._open_equipment(self.document, driven)
        await self._open_equipped_devices(self.document)
        await self._open_robots(self.document, world, driven)
        self._stack.push_async_callback(self._close_bus)

    async def _close_bus(self) -> None:
        """Cancel all active goals; a handler that does not end does not prevent the robots from coming to rest."""
        closing = asyncio.create_task(self.bus.__aexit__(None, None, None), name="closing the bus")
        await _wait_uncancelled((closing,))
        if closing.done() and not closing.cancelled():
            closing.result()
        for goal in self.bus.goals():
            _log.error("the handler of %s does not end; its robot is stopped without it", goal.address)

    async def _open_store(self, cell: Cell) -> None:
        if cell.document.store is None:
            return
        store = await open_cell_store(cell, self._store_path, inline=self.bus.clock.virtual)
        self.store = await self._stack.enter_async_context(store)
        if cell.seed_file is not None:
            seed = load_entries(cell.seed_file).records()
            await store.seed(seed, by=f"cell {cell.name}", reason=f"seed {cell.seed_file.name}")
        register_store(self.bus, store)
        await publish_changes(self.bus, store)

    async def _open_world(self, cell: Cell) -> World | None:
        if cell.document.world is None:
            return None
        new_world: NewWorld = load_factory(WORLDS, "mujoco")
        world = await self._stack.enter_async_context(
            new_world(
                cell,
                bus=self.bus,
                virtual=self.bus.clock.virtual,
                seed=self.seed,
                new_stop_line=self.relay.new_line if self.relay is not None else None,
            )
        )
        world.register(self.bus)
        self._world = world
        self._connections.follow(world)
        return world

    async def _open_equipment(self, cell: Cell, driven: Mapping[str, AssignedDriver]) -> None:
        """Open the equipment, before the arms that may use it."""
        opened: dict[str, Robot] = {}
        for name in cell.document.equipment:
            if name in driven:
                opened[name] = self._driven(driven[name], opened)
            else:
                simulate: Callable[..., Robot] = load_factory(WORLDS, "equipment")
                opened[name] = simulate(cell.pins[name].document, name=name)
            await self._open_device(opened[name])
            # At once: what was opened before an error is brought to rest too.
            self.equipment = dict(opened)

    async def _open_equipped_devices(self, cell: Cell) -> None:
        """Open what moves by pins of equipment; a world serves the other devices."""
        if any(device.equipment is not None for device in cell.document.devices.values()):
            new_devices: Callable[..., Robot] = load_factory(WORLDS, "devices")
            devices = new_devices(cell, bus=self.bus)
            await self._open_device(devices)
            self._equipped_devices = (devices,)

    async def _open_robots(self, cell: Cell, world: World | None, driven: Mapping[str, AssignedDriver]) -> None:
        simulated = {robot.name: robot for robot in world.robots()} if world is not None else {}
        robots: dict[str, Robot] = {}
        tools: dict[str, Robot] = {}
        for name, entry in cell.document.robots.items():
            robots[name] = simulated[name] if entry.simulated else self._driven(driven[name], robots)
            await self._open_device(robots[name])
            if f"{name}/gripper" in driven:
                tool = self._driven(driven[f"{name}/gripper"], ChainMap(robots, dict(self.equipment)))
                await self._open_device(tool)
                tools[tool.name] = tool
        self.robots = robots
        self.tools = tools
        real = frozenset(name for name, entry in cell.document.robots.items() if not entry.simulated)
        if real:
            self._real_arms = TopicMeasures(real)
            self._stack.callback(self._real_arms.listen(self.bus))

    async def _open_device(self, device: Robot) -> None:
        robot = await self._stack.enter_async_context(device)
        robot.register(self.bus)
        self._connections.follow(robot)

    def _driven(self, assigned: AssignedDriver, opened: Mapping[str, Robot]) -> Robot:
        """Return the device of a driver, which refuses what the driver cannot do with the reason."""
        try:
            driver = assigned.driver()
            name = assigned.device_name(driver)
            context = DeviceContext(
                cell=assigned.cell,
                robot=assigned.robot,
                world=self._world,
                devices=opened,
                new_stop_line=self.relay.new_line if self.relay is not None else None,
                capture=self._capture,
            )
            options = assigned.options(driver)
            device = driver.new_device(options, name=name, clock=self.bus.clock, context=context)
        except DocumentError:
            raise  # it has the position of the option
        except FlexcellError as error:
            where = f"{assigned.words} of {assigned.cell.file}"
            raise CellError(error.message, where=where, hint=error.hint) from error
        self.bus.explain_missing(name, driver.configured(options).lacks_for_skill)
        return device


async def _wait_uncancelled(tasks: tuple[asyncio.Task[None], ...]) -> None:
    """Wait until the tasks have ended; cancel those that take too long.

    Cancelling the caller does not interrupt them: a stop, once started, is completed.
    """
    loop = asyncio.get_running_loop()
    deadline_s = loop.time() + _PATIENCE_S
    cancelled: asyncio.CancelledError | None = None
    pending = set(tasks)
    while pending and loop.time() < deadline_s:
        try:
            _, pending = await asyncio.wait(pending, timeout=deadline_s - loop.time())
        except asyncio.CancelledError as error:
            cancelled = error
    # A task that suppresses its cancellation is abandoned and named in the log.
    with suppress(NotStopped):
        late = [task for task in tasks if task in pending]
        await preempt(late, OverduePolicy(report=_log_overdue, abandon=_log_abandoned, abandon_after_s=_PATIENCE_S))
    if cancelled is not None:
        raise cancelled


def _failure(stop: asyncio.Task[None], device: Robot) -> BaseException | None:
    """Return the error of a device that did not confirm rest; None when it did."""
    if stop.done() and not stop.cancelled():
        return stop.exception()
    return RobotError(f"the device did not confirm rest within {_PATIENCE_S:g} s", where=device.name)


def _log_overdue(name: str, waited_s: float) -> None:
    _log.error("%s has not ended %g s after it was cancelled", name, waited_s)


def _log_abandoned(task: asyncio.Task[Any], waited_s: float) -> None:
    _log.error("%s was abandoned %g s after it was cancelled", task.get_name(), waited_s)

"""The modules of a simulated cell on the bus: plug and unplug them, and tell everybody what is in the world then."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Coroutine, Mapping
from typing import Any

from msgspec.structs import replace

from engine.bus import SkillBus, Topic
from engine.document import Cell, FramedPlacement, cell_as_docked, docks_at_start, modules_below, poses_in_world
from engine.errors import RobotError, SkillFailed
from engine.messages import Pose
from engine.skills.modules import MODULES_TOPIC, CellModules, ModuleState, PlugModule, UnplugModule
from engine.wording import did_you_mean
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.docked_scene import docked_scene, with_moved_fixtures
from robots.scene.sim_scene import SimScene
from robots.sim.commands.world_commands import ModulePlaced, PlaceModule
from robots.sim.host.world_host import WorldHost
from robots.sim.physics.module_fixtures import POSE_FIELDS, read_pose

# Poses that are so near, in metres and radians, are those of one connector.
_SAME = 1e-6

SceneListener = Callable[[SimScene], None]
"""Takes what is in the world now; called on the event loop, before the request that changed it returns."""


class ModuleServices:
    """Knows what is in the world; without a cell, or without modules, that never changes.

    Args:
        world: The namespace of the world on the bus.
        whole: The scene with everything that may be in the world.
        host: Where the world runs.
        cell: The cell, for its modules.
    """

    def __init__(self, world: str, whole: SimScene, host: WorldHost, *, cell: Cell | None) -> None:
        self._world = world
        self._whole = whole
        self._host = host
        self._cell = cell if cell is not None and cell.modules else None
        self._listeners: list[SceneListener] = []
        self._followers: list[SceneListener] = []
        self._frame_listeners: list[Callable[[], None]] = []
        self._topic: Topic[CellModules] | None = None
        self.changing = asyncio.Lock()
        """Held while the world changes what is in it, or is restored."""
        self._changes: set[asyncio.Task[ModuleState]] = set()
        self.docks: dict[str, str] = {}
        """The connector of each plugged module."""
        self.away: frozenset[str] = frozenset()
        """The parts that are on modules which are not plugged."""
        self.document = cell.document if cell is not None else None
        """The document of the cell with only the modules that are plugged; None without a cell."""
        self.scene = whole
        """What is in the world now."""
        self.frames: dict[str, Pose] = dict(whole.frames)
        """The poses in the world of all named frames that are there now; always the same mapping."""
        self.begin()

    def watch(self, listener: SceneListener) -> None:
        """Call `listener` after each change of what is in the world."""
        self._listeners.append(listener)

    def follow(self, listener: SceneListener) -> None:
        """Call `listener` when devices have moved fixtures too."""
        self._listeners.append(listener)
        self._followers.append(listener)

    def home_of(self, fixture: str) -> Pose | None:
        """Return where the cell document places a fixture; None while its module is not plugged."""
        fixtures = self.document.fixtures if self.document is not None else {}
        return fixtures[fixture].at.pose() if fixture in fixtures else None

    def follow_frames(self, listener: Callable[[], None]) -> None:
        """Call `listener` when devices have moved what named frames stand on."""
        self._frame_listeners.append(listener)

    def frames_moved(self, poses: Mapping[str, Pose]) -> None:
        """Take where the named frames on moved fixtures are, whose poses in the world are given."""
        document = self.document
        if document is None or not document.frames:
            return
        placed = {name: replace(document.fixtures[name], at=FramedPlacement.of(pose)) for name, pose in poses.items()}
        frames = poses_in_world(document.frames, {**document.fixtures, **placed})
        self.frames.update({name: frames[name] for name in self.frames})
        self.scene = replace(self.scene, frames=dict(self.frames))
        for listener in self._frame_listeners:
            listener()

    def fixtures_moved(self, poses: Mapping[str, Pose], *, loose: Collection[str] = ()) -> None:
        """Take where devices have moved fixtures, with the arms on them, and tell those who follow them.

        The carriages in `loose` are released: they may move on at any time.
        """
        self.scene = with_moved_fixtures(self.scene, poses, whole=self._whole, loose=loose)
        for listener in self._followers:
            listener(self.scene)

    def begin(self) -> None:
        """Take the state of a world that was built anew."""
        if self._cell is not None:
            docks = docks_at_start(self._cell)
            self._take_over(docks, self._parts_of_others(docks))

    def take_image(self, image: Array) -> None:
        """Take the state of a world that was restored to an image.

        Raises:
            RobotError: a module stands at no connector of the cell.
        """
        if self._cell is None:
            return
        modules = self._whole.modules
        parts = [part for module in modules for part in module.parts]
        start, count = self._host.summary.modules_at, len(modules) + len(parts)
        rows = image[start : start + POSE_FIELDS * count].reshape(-1, POSE_FIELDS)
        poses = {module.name: read_pose(row) for module, row in zip(modules, rows, strict=False)}
        away = [part for part, row in zip(parts, rows[len(modules) :], strict=True) if row[0]]
        self._take_over(self._docks_at({name: pose for name, pose in poses.items() if pose is not None}), away)

    def _take_over(self, docks: Mapping[str, str], away: Collection[str]) -> None:
        """Take the state of a world that was changed or restored, and tell everybody."""
        if self._cell is None:
            return
        self.docks, self.away = dict(docks), frozenset(away)
        self.document = cell_as_docked(self._cell, self.docks)
        self.scene = docked_scene(self._whole, self.document, away=self.away)
        self.frames.clear()
        self.frames.update(self.scene.frames)
        for listener in self._listeners:
            listener(self.scene)
        if self._topic is not None:
            self._topic.publish(self._state())

    def parts_were_reset(self) -> None:
        """Take note that all parts of modules are on their modules again."""
        gone = self._parts_of_others(self.docks)
        if gone != self.away:
            self._take_over(self.docks, gone)

    def register(self, bus: SkillBus) -> None:
        """Advertise the services of each module under its name, and publish the state of all."""
        if self._cell is None:
            return
        for name in self._cell.modules:
            bus.advertise_service(PlugModule, self._plug_service(name), namespace=name, commands=name)
            bus.advertise_service(UnplugModule, self._unplug_service(name), namespace=name, commands=name)
        self._topic = bus.topic(MODULES_TOPIC, CellModules)
        self._topic.publish(self._state())

    def _plug_service(self, name: str) -> Callable[[PlugModule], object]:
        async def plug(request: PlugModule) -> ModuleState:
            return await self.plug(name, request.connector)

        return plug

    def _unplug_service(self, name: str) -> Callable[[UnplugModule], object]:
        async def unplug(_request: UnplugModule) -> ModuleState:
            return await self.unplug(name)

        return unplug

    async def plug(self, name: str, connector: str = "") -> ModuleState:
        """Plug a module into a connector, the one of the cell document by default.

        Once begun it is completed, also when the caller is cancelled: what is in the world is always known.

        Raises:
            SkillFailed: it cannot be plugged there; nothing has changed.
            RobotError: the world is lost.
        """
        return await self._completed(self._plug(name, connector))

    async def unplug(self, name: str) -> ModuleState:
        """Unplug a module, with the parts on it; completed as `plug` is.

        Raises:
            SkillFailed: it cannot be unplugged; nothing has changed.
            RobotError: the world is lost.
        """
        return await self._completed(self._unplug(name))

    async def _completed(self, change: Coroutine[Any, Any, ModuleState]) -> ModuleState:
        task = asyncio.create_task(change, name="changing the modules")
        self._changes.add(task)
        task.add_done_callback(self._changed)
        return await asyncio.shield(task)

    def _changed(self, task: asyncio.Task[ModuleState]) -> None:
        self._changes.discard(task)
        if not task.cancelled():
            task.exception()  # the caller may be gone

    async def _plug(self, name: str, connector: str) -> ModuleState:
        async with self.changing:
            cell = self._of(name)
            where = self._free_connector(cell, name, connector)
            docks = {**self.docks, name: where}
            pose = cell_as_docked(cell, docks).fixed_frames[name]
            placed = await self._host.place_module(PlaceModule(module=name, pose=pose))
            if placed.refused:
                raise self._refused(
                    f"{name} cannot be plugged to {where}: {placed.refused}", hint="move it away, then plug it again"
                )
            return self._took(name, docks, placed)

    async def _unplug(self, name: str) -> ModuleState:
        async with self.changing:
            cell = self._of(name)
            if name not in self.docks:
                raise self._refused(f"{name} is not plugged", hint=f"plugged are {', '.join(self.docks) or 'none'}")
            self._require_bare(cell, name)
            docks = {module: where for module, where in self.docks.items() if module != name}
            placed = await self._host.place_module(PlaceModule(module=name, pose=None))
            if placed.refused:
                raise self._refused(
                    f"{name} cannot be unplugged: {placed.refused}", hint="take it away first, then unplug the module"
                )
            return self._took(name, docks, placed)

    def _docks_at(self, poses: Mapping[str, RigidTransform]) -> dict[str, str]:
        """Return the connectors of modules that stand at these poses; connectors may be on other modules."""
        cell, docks = self._cell, dict[str, str]()
        assert cell is not None
        while len(docks) < len(poses):
            frames = cell_as_docked(cell, docks).fixed_frames
            free = {name: RigidTransform.from_pose(frames[name]) for name in self._free(cell, docks)}
            found = {
                module: name
                for module, pose in poses.items()
                for name, place in free.items()
                if module not in docks and place.distance_m(pose) < _SAME and place.angle_rad(pose) < _SAME
            }
            if not found:
                lost = next(name for name in poses if name not in docks)
                raise RobotError(f"{lost} stands at no connector", where=self._world, hint="connect the cell anew")
            docks |= found
        return docks

    def _parts_of_others(self, docks: Mapping[str, str]) -> frozenset[str]:
        """Return the parts of the modules that are not plugged."""
        modules = self._whole.modules
        return frozenset(part for module in modules if module.name not in docks for part in module.parts)

    def _of(self, name: str) -> Cell:
        cell = self._cell
        if cell is None or name not in cell.modules:
            known = tuple(cell.modules) if cell is not None else ()
            raise self._refused(f"the cell has no module {name}", hint=did_you_mean(name, known))
        if cell.modules[name].document.cameras:
            raise self._refused(
                f"{name} carries cameras, and such a module cannot be plugged or unplugged while the cell is open",
                hint="change the cell document and connect the cell anew",
            )
        return cell

    def _free_connector(self, cell: Cell, name: str, connector: str) -> str:
        if name in self.docks:
            raise self._refused(f"{name} is plugged to {self.docks[name]} already", hint="unplug it first")
        where = connector or cell.document.modules[name].connector
        free = self._free(cell, self.docks)
        if not where:
            raise self._refused(
                f"{name} has no connector in the cell document", hint=f"name one of {', '.join(free) or 'none'}"
            )
        if where not in cell.document.connectors:
            raise self._refused(
                f"the cell has no connector {where}", hint=did_you_mean(where, cell.document.connectors)
            )
        carried = next((module for module, at in self.docks.items() if at == where), "")
        if carried:
            raise self._refused(
                f"{carried} is plugged to {where}",
                hint=f"unplug {carried}, or choose one of {', '.join(free) or 'no other'}",
            )
        below = modules_below(cell).get(where, "")
        if below and below not in self.docks:
            raise self._refused(f"{where} is on {below}, which is not plugged", hint=f"plug {below} first")
        return where

    def _require_bare(self, cell: Cell, name: str) -> None:
        if name in cell.carried:
            raise self._refused(
                f"{name} cannot be unplugged: {cell.carried[name]} stands on it", hint="place it elsewhere in the cell"
            )
        below = modules_below(cell)
        upper = next((module for module, where in self.docks.items() if below.get(where) == name), "")
        if upper:
            raise self._refused(f"{name} cannot be unplugged: {upper} is plugged to it", hint=f"unplug {upper} first")

    def _took(self, name: str, docks: Mapping[str, str], placed: ModulePlaced) -> ModuleState:
        self._take_over(docks, placed.away)
        return next(each for each in self._state().modules if each.module == name)

    def _state(self) -> CellModules:
        cell = self._cell
        assert cell is not None
        parts = {module.name: module.parts for module in self._whole.modules}
        return CellModules(
            modules=tuple(
                ModuleState(
                    module=name,
                    kind=module.document.module,
                    connector=self.docks.get(name, ""),
                    away=tuple(part for part in parts[name] if part in self.away),
                )
                for name, module in cell.modules.items()
            ),
            free=self._free(cell, self.docks),
        )

    def _free(self, cell: Cell, docks: Mapping[str, str]) -> tuple[str, ...]:
        below, taken = modules_below(cell), set(docks.values())
        return tuple(
            name
            for name in cell.document.connectors
            if name not in taken and (name not in below or below[name] in docks)
        )

    def _refused(self, message: str, *, hint: str) -> SkillFailed:
        return SkillFailed(message, where=self._world, hint=hint)

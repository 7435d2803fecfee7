"""The workspace of a cell as a device: serves the planning scene to the bus and to the arms that move in it."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Protocol, Self

import msgspec

from engine.bus import SkillBus, Topic
from engine.clock import Clock
from engine.errors import FlexcellError, RobotError, SkillFailed
from engine.messages.sensing import CameraStatus, ObservedSpace, OccupancyGrid
from engine.robot import DeviceStatus
from engine.skills.planning_scene import (
    AllowContact,
    AttachPart,
    CheckCollision,
    CollisionReport,
    DetachPart,
    ForgetOccupancy,
    PlanningSceneState,
    PutObstacle,
    ReadPlanningScene,
    RemoveObstacle,
)
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene
from robots.port import GraspCommand
from robots.scene.sim_scene import SimScene
from robots.vision.occupancy.occupancy_source import OccupancySource
from robots.workspace.collision_reports import collision_report
from robots.workspace.live_scene import OCCUPANCY, LiveScene, SceneMemo
from robots.workspace.monitored_separation import MonitoredSeparation
from robots.workspace.occupancy_freshness import wait_until_fresh
from robots.workspace.path_reservations import Row
from robots.workspace.planning_services import PlanningServices
from robots.workspace.unknown_space import UnknownSpaceRule, describe_unhealthy

LOOK_S = 0.05
"""Period of the measurements while there are listeners."""

ChangeListener = Callable[[frozenset[str]], None]
_log = logging.getLogger("flexcell.workspace")


class SceneMaker(Protocol):
    """Creates the scene of a cell; loads Coal and takes some tenths of a second the first time."""

    def __call__(self) -> LiveScene:
        """Return the scene of the cell document."""
        ...


class Workspace:
    """Implements `engine.robot.Robot` under a name that no robot has; its skills are those of the cell.

    Args:
        make_scene: Creates the live scene at first use.
        planners: Plan and check paths.
        clock: The cell's clock.
        occupancy: The occupancy map of the cameras, if the cell has cameras.
        unknown_space: What the cell demands of space that the cameras have not seen.
        separation: What separation monitoring permits; None for a cell without.
    """

    name = "cell/workspace"

    def __init__(
        self,
        make_scene: SceneMaker,
        *,
        planners: PlanningServices,
        clock: Clock,
        occupancy: OccupancySource | None = None,
        unknown_space: UnknownSpaceRule | None = None,
        separation: MonitoredSeparation | None = None,
    ) -> None:
        self._make_scene = make_scene
        self._live: LiveScene | None = None
        self._making = asyncio.Lock()
        self._early_memo = SceneMemo()
        self._cell_scene: SimScene | None = None
        self.planners = planners
        self._clock = clock
        self._occupancy = occupancy
        self.unknown_space = unknown_space or UnknownSpaceRule()
        self.separation = separation
        self._unsubscribe: Callable[[], None] = _no_operation
        self._topic: Topic[PlanningSceneState] | None = None
        self._watchers: list[ChangeListener] = []
        self._measuring: asyncio.Task[None] | None = None
        self._preparing: asyncio.Task[None] | None = None
        self._published_revision = -1
        self.status = DeviceStatus.DISCONNECTED

    @property
    def occupancy(self) -> OccupancyGrid | None:
        """The current occupancy of the cameras; None without cameras."""
        return self._occupancy.latest if self._occupancy is not None else None

    @property
    def observed(self) -> ObservedSpace | None:
        """When the cameras last saw each voxel; None without cameras."""
        return self._occupancy.observed if self._occupancy is not None else None

    @property
    def camera_statuses(self) -> tuple[CameraStatus, ...]:
        """The status of each camera of the map."""
        return self._occupancy.camera_statuses if self._occupancy is not None else ()

    @property
    def stale_reason(self) -> str:
        """Why the occupancy is not valid; empty if it is, or without cameras."""
        return self._occupancy.stale_reason if self._occupancy is not None else ""

    @property
    def unobserved_reason(self) -> str:
        """Why the scene is not observed: an invalid map, or an unhealthy camera; empty if it is."""
        if self.stale_reason:
            return f"the occupancy map is not valid: {self.stale_reason}"
        return self.unhealthy_reason

    @property
    def unhealthy_reason(self) -> str:
        """Which cameras are unhealthy and why; empty if none is."""
        return describe_unhealthy(self.camera_statuses)

    async def pause(self) -> None:
        """Return after the period of the measurements."""
        await self._clock.sleep(LOOK_S)

    @property
    def shared(self) -> bool:
        """True if the cell has more than one arm."""
        return self._scene().arms > 1

    @property
    def part_names(self) -> frozenset[str]:
        """Names of the parts of the cell; await `ready` first."""
        return self._scene().part_names

    def scene_for(self, arm: str) -> PlanningScene:
        """Return the current scene for `arm`; await `ready` first."""
        live = self._scene()
        self._refresh(live)
        return live.scene_for(arm)

    def holds(self, arm: str) -> bool:
        """Return whether an arm holds a part, attached or by contact; before `ready` only what is remembered."""
        if self._live is None:
            return any(memo.part.arm == arm for memo in self._early_memo.held)
        self._refresh(self._live)
        return self._live.holds(arm)

    def attached_to(self, arm: str) -> tuple[AttachedPart, ...]:
        """Return the parts that an arm held at the last measurement."""
        return self._live.attached_to(arm) if self._live is not None else ()

    def lies(self, arm: str) -> bool:
        """Return whether a part held by an arm still touches what it was picked from; await `ready` first."""
        return self._scene().lies(arm)

    def attached_check_scene_for(self, arm: str) -> PlanningScene | None:
        """Return the current scene to check the attached parts of `arm`, None if it holds nothing."""
        live = self._scene()
        self._refresh(live)
        return live.attached_check_scene_for(arm)

    async def ready(self) -> None:
        """Return when the scene exists, without blocking the event loop."""
        async with self._making:
            if self._live is not None:
                return
            # In virtual time nothing may depend on the speed of this machine.
            made = self._make_scene() if self._clock.virtual else await asyncio.to_thread(self._make_scene)
            if self._live is None:
                self._start_with(made)

    def require(self) -> None:
        """Keep the cameras running until `release`."""
        if self._occupancy is not None:
            self._occupancy.require()

    def release(self) -> None:
        """Undo one `require`."""
        if self._occupancy is not None:
            self._occupancy.release()

    async def fresh(self) -> None:
        """Return when the occupancy is valid; call `require` first. Waits longer for cameras that are still starting.

        Raises:
            RobotError: the occupancy is not valid in time; the message gives the reason.
        """
        if self._occupancy is not None:
            await wait_until_fresh(self._occupancy)

    def watch(self, watcher: ChangeListener) -> Callable[[], None]:
        """Call `watcher` with the names of changed objects, until the returned function is called.

        `occupancy` stands for everything that the cameras see.
        """
        self._watchers.append(watcher)
        if self._measuring is None:
            self._measuring = asyncio.create_task(self._measure(), name="measuring the cell")
        return lambda: self._end_watch(watcher)

    def claim(self, arm: str, rows: tuple[Row, ...]) -> None:
        """Reserve the configurations that a moving arm will pass (radians, n each); empty releases them."""
        self._scene().claim(arm, rows)
        self._notify({arm})

    def take_scene(self, scene: SimScene) -> None:
        """Take what is in the cell from now on; whoever moves there checks its path anew."""
        self._cell_scene = scene
        if self._live is not None:
            self._take_cell_scene(self._live)
        elif self._occupancy is not None and self._clock.virtual:
            # The cameras have to know what they see.
            self._scene()

    def register(self, bus: SkillBus) -> None:
        """Advertise the services under `cell` and publish `cell/planning_scene`."""
        bus.advertise_service(ReadPlanningScene, self._read, namespace="cell")
        bus.advertise_service(PutObstacle, self._put, namespace="cell")
        bus.advertise_service(RemoveObstacle, self._remove, namespace="cell")
        bus.advertise_service(AllowContact, self._allow, namespace="cell")
        bus.advertise_service(AttachPart, self._attach, namespace="cell")
        bus.advertise_service(DetachPart, self._detach, namespace="cell")
        bus.advertise_service(ForgetOccupancy, self._forget, namespace="cell")
        bus.advertise_service(CheckCollision, self._check, namespace="cell")
        self._topic = bus.topic("cell/planning_scene", PlanningSceneState)
        if self._live is not None:
            self._topic.publish(self._live.state())

    def grips(self) -> dict[str, GraspCommand]:
        """Return no grasp commands: a workspace has no gripper."""
        return {}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Do nothing: a workspace has no gripper."""

    def memo(self) -> bytes:
        """Return the state that a restore needs."""
        memo = self._live.memo() if self._live is not None else self._early_memo
        return msgspec.msgpack.encode(memo, order="deterministic") if memo != SceneMemo() else b""

    def remember(self, memo: bytes) -> None:
        """Restore the state of `memo`; raises RobotError for invalid bytes."""
        try:
            known = msgspec.msgpack.decode(memo, type=SceneMemo) if memo else SceneMemo()
        except msgspec.DecodeError as error:
            raise RobotError(f"the planning scene in the snapshot cannot be read: {error}", where=self.name) from error
        if self._live is None:
            self._early_memo = known
            return
        self._live.remember(known)
        self._notify(set())

    async def stop(self) -> None:
        """Do nothing: a workspace has no motion."""

    async def __aenter__(self) -> Self:
        self.status = DeviceStatus.READY
        if self._occupancy is not None:
            self._unsubscribe = self._occupancy.subscribe(lambda: self._notify({OCCUPANCY}))
            self.planners.begin()
        if not self._clock.virtual:
            self._preparing = asyncio.create_task(self._prepare(), name="preparing the planning scene")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.status = DeviceStatus.DISCONNECTED
        self._unsubscribe()
        for task in (self._measuring, self._preparing):
            if task is not None:
                task.cancel()
                await asyncio.wait((task,))
        self._measuring = self._preparing = None
        await self.planners.close()

    async def _prepare(self) -> None:
        try:
            await self.ready()
        except FlexcellError as error:
            # No caller is waiting yet; the first call reports the error.
            _log.warning("the planning scene cannot be created: %s", error)

    def _scene(self) -> LiveScene:
        if self._live is None:
            self._start_with(self._make_scene())
        assert self._live is not None
        return self._live

    def _start_with(self, live: LiveScene) -> None:
        live.remember(self._early_memo)
        live.refresh()
        self._live, self._published_revision = live, live.revision
        self._publish(live)
        if self._cell_scene is not None:
            # It may have changed while this one was made, on a thread.
            self._take_cell_scene(live)

    def _take_cell_scene(self, live: LiveScene) -> None:
        # Loaded with the scene, as it is in `make_scene`.
        from robots.planning.scene.cell_planning_scene import known_obstacles

        assert self._cell_scene is not None
        parts = tuple(part.name for part in self._cell_scene.parts)
        changed = live.take_base(known_obstacles(self._cell_scene), parts=parts, arms=self._cell_scene.arms)
        self._notify(changed | live.refresh())

    def _refresh(self, live: LiveScene) -> None:
        changed = live.refresh()
        if changed:
            self._notify(changed)

    def _notify(self, changed: set[str] | frozenset[str]) -> None:
        """Notify the listeners, and publish the scene if it has changed."""
        for watcher in tuple(self._watchers):
            try:
                watcher(frozenset(changed))
            except Exception:
                # The motion of one arm may fail in any way; those of others must learn of the change.
                _log.exception("a watcher of the workspace failed")
        live = self._live
        if live is None or live.revision == self._published_revision:
            return
        self._published_revision = live.revision
        self._publish(live)

    def _publish(self, live: LiveScene) -> None:
        """Send the scene to the cameras and the bus."""
        if self._occupancy is not None:
            self._occupancy.know(live.whole())
        if self._topic is not None:
            self._topic.publish(live.state())

    async def _measure(self) -> None:
        failure = ""
        while True:
            await self._clock.sleep(LOOK_S)
            try:
                await self.ready()
                self._refresh(self._scene())
                failure = ""
            except Exception as error:
                # Whatever fails, moving arms must not continue as if nothing had changed.
                if str(error) != failure:
                    failure = str(error)
                    _log.warning(
                        "the scene is not measured: %s", failure, exc_info=not isinstance(error, FlexcellError)
                    )
                # Whoever watches checks its path, and gets the same error.
                self._notify(set())

    def _end_watch(self, watcher: ChangeListener) -> None:
        if watcher in self._watchers:
            self._watchers.remove(watcher)
        if not self._watchers and self._measuring is not None:
            self._measuring.cancel()
            self._measuring = None

    async def _read(self, request: ReadPlanningScene) -> PlanningSceneState:
        return await self._changed(lambda _live: None)

    async def _put(self, request: PutObstacle) -> PlanningSceneState:
        return await self._changed(lambda live: live.put(request.obstacle), {request.obstacle.name})

    async def _remove(self, request: RemoveObstacle) -> PlanningSceneState:
        return await self._changed(lambda live: live.remove(request.name), {request.name})

    async def _allow(self, request: AllowContact) -> PlanningSceneState:
        return await self._changed(
            lambda live: live.allow(request.first, request.second, allowed=request.allowed),
            {request.first, request.second},
        )

    async def _attach(self, request: AttachPart) -> PlanningSceneState:
        # Every motion from now on is checked; start the planners so that the first one need not wait.
        self.planners.begin()
        return await self._changed(lambda live: live.attach(request.part, request.robot, request.link), {request.part})

    async def _detach(self, request: DetachPart) -> PlanningSceneState:
        return await self._changed(lambda live: live.detach(request.part), {request.part})

    async def _forget(self, request: ForgetOccupancy) -> PlanningSceneState:
        if self._occupancy is not None:
            self._occupancy.forget()
        return await self._changed(lambda _live: None)

    async def _check(self, request: CheckCollision) -> CollisionReport:
        await self.ready()
        live = self._scene()
        self._refresh(live)
        try:
            return await collision_report(self.planners, live.whole(), request, occupancy=self.occupancy)
        except FlexcellError as error:
            raise SkillFailed(error.message, where="cell", hint=error.hint) from error

    async def _changed(self, change: Callable[[LiveScene], None], names: set[str] | None = None) -> PlanningSceneState:
        await self.ready()
        live = self._scene()
        self._refresh(live)
        change(live)
        self._notify(names or set())
        return live.state()


def _no_operation() -> None:
    """Do nothing."""

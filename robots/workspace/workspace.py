"""The workspace of a cell as a device: answers for the planning scene, and serves the arms that move in it."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Protocol, Self

import msgspec

from engine.bus import SkillBus
from engine.bus.topic import Topic
from engine.clock import Clock
from engine.errors import FlexcellError, RobotError, SkillFailed
from engine.messages.sensing import OccupancyGrid
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
from robots.gripper.grasp_check import GraspCommand
from robots.planning.request import CollisionRequest
from robots.planning.scene.planning_scene import PlanningScene
from robots.vision.occupancy_source import OccupancySource
from robots.workspace.live_scene import OCCUPANCY, LiveScene, SceneMemo
from robots.workspace.path_reservations import Row
from robots.workspace.planning_services import PlanningServices

LOOK_S = 0.05
"""How often the cell is looked at while somebody watches."""

_FRESH_S = 3.0
_STARTED_S = 120.0
"""How long the cameras may take to start: on a new machine everything is compiled first."""

ChangeListener = Callable[[frozenset[str]], None]
_log = logging.getLogger("flexcell.workspace")


class SceneMaker(Protocol):
    """Makes the scene of a cell; it loads coal and takes some tenths of a second the first time."""

    def __call__(self) -> LiveScene:
        """Return it, as the cell document has it."""
        ...


class Workspace:
    """Implements `engine.robot.Robot` under a name that no robot has; its skills are the cell's.

    Args:
        make_scene: Makes the live scene, at the first need.
        planners: Who plans and checks.
        clock: The cell's.
        occupancy: What the cameras see, if there are some.
    """

    name = "cell/workspace"

    def __init__(
        self,
        make_scene: SceneMaker,
        *,
        planners: PlanningServices,
        clock: Clock,
        occupancy: OccupancySource | None = None,
    ) -> None:
        self._make_scene = make_scene
        self._live: LiveScene | None = None
        self._making = asyncio.Lock()
        self._early_memo = SceneMemo()
        self.planners = planners
        self._clock = clock
        self._occupancy = occupancy
        self._unsubscribe: Callable[[], None] = _nothing
        self._topic: Topic[PlanningSceneState] | None = None
        self._watchers: list[ChangeListener] = []
        self._looking: asyncio.Task[None] | None = None
        self._preparing: asyncio.Task[None] | None = None
        self._told = -1
        self.status = DeviceStatus.DISCONNECTED

    @property
    def occupancy(self) -> OccupancyGrid | None:
        """What the cameras see now; None without cameras."""
        return self._occupancy.latest if self._occupancy is not None else None

    @property
    def stale_reason(self) -> str:
        """Why what the cameras see must not be trusted, empty where it may, or where there are none."""
        return self._occupancy.stale_reason if self._occupancy is not None else ""

    @property
    def shared(self) -> bool:
        """Whether more arms than one move in it."""
        return self._scene().arms > 1

    def scene_for(self, arm: str) -> PlanningScene:
        """Return the scene as `arm` meets it at this moment; `ready` has been awaited."""
        live = self._scene()
        self._take_in(live)
        return live.scene_for(arm)

    def holds(self, arm: str) -> bool:
        """Whether an arm holds something that the scene knows of; what it has just lost may still count."""
        if self._live is None:
            return any(memo.part.arm == arm for memo in self._early_memo.held)
        return self._live.holds(arm)

    def lies(self, arm: str) -> bool:
        """Whether what an arm holds has not yet parted from what it was taken from; `ready` has been awaited."""
        return self._scene().lies(arm)

    def attached_check_scene_for(self, arm: str) -> PlanningScene | None:
        """Return the scene as what `arm` holds meets it at this moment, None where it holds nothing."""
        live = self._scene()
        self._take_in(live)
        return live.attached_check_scene_for(arm)

    async def ready(self) -> None:
        """Return when the scene is there, without holding up the loop."""
        async with self._making:
            if self._live is not None:
                return
            # In virtual time nothing may depend on how fast this machine is.
            made = self._make_scene() if self._clock.virtual else await asyncio.to_thread(self._make_scene)
            if self._live is None:
                self._begin_with(made)

    def require(self) -> None:
        """Let the cameras take images until `release`."""
        if self._occupancy is not None:
            self._occupancy.require()

    def release(self) -> None:
        """End what `require` began."""
        if self._occupancy is not None:
            self._occupancy.release()

    async def fresh(self) -> None:
        """Return when the occupancy may be trusted; `require` was called. Cameras that are still starting have time.

        Raises:
            RobotError: it may not be, for too long; the message says why.
        """
        source = self._occupancy
        if source is None or not source.stale_reason:
            return
        news = asyncio.Event()
        unsubscribe = source.subscribe(news.set)
        try:
            async with asyncio.timeout(_STARTED_S):
                while source.starting and source.stale_reason:
                    await news.wait()
                    news.clear()
            async with asyncio.timeout(_FRESH_S):
                while source.stale_reason:
                    await news.wait()
                    news.clear()
        except TimeoutError:
            raise RobotError(
                f"the occupancy map is not valid: {source.stale_reason}",
                where=OCCUPANCY,
                hint="see that the cameras work, then try again",
            ) from None
        finally:
            unsubscribe()

    def watch(self, watcher: ChangeListener) -> Callable[[], None]:
        """Call `watcher` with the names of what has changed, until the returned function is called.

        `occupancy` stands for all that the cameras see.
        """
        self._watchers.append(watcher)
        if self._looking is None:
            self._looking = asyncio.create_task(self._look_on(), name="looking at the cell")
        return lambda: self._end_watch(watcher)

    def claim(self, arm: str, rows: tuple[Row, ...]) -> None:
        """Say where an arm on its way will be (radians, n each), or with nothing that it is on none."""
        self._scene().claim(arm, rows)
        self._tell({arm})

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
        """Nothing: it has no gripper."""
        return {}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Nothing is known of grippers here."""

    def memo(self) -> bytes:
        """What must be known again after a restore."""
        memo = self._live.memo() if self._live is not None else self._early_memo
        return msgspec.msgpack.encode(memo) if memo != SceneMemo() else b""

    def remember(self, memo: bytes) -> None:
        """Know again what `memo` says; raises RobotError where these bytes are none."""
        try:
            known = msgspec.msgpack.decode(memo, type=SceneMemo) if memo else SceneMemo()
        except msgspec.DecodeError as error:
            raise RobotError(f"the planning scene in the snapshot cannot be read: {error}", where=self.name) from error
        if self._live is None:
            self._early_memo = known
            return
        self._live.remember(known)
        self._tell(set())

    async def stop(self) -> None:
        """Nothing here moves."""

    async def __aenter__(self) -> Self:
        self.status = DeviceStatus.READY
        if self._occupancy is not None:
            self._unsubscribe = self._occupancy.subscribe(lambda: self._tell({OCCUPANCY}))
            self.planners.begin()
        if not self._clock.virtual:
            self._preparing = asyncio.create_task(self._prepare(), name="preparing the planning scene")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.status = DeviceStatus.DISCONNECTED
        self._unsubscribe()
        for task in (self._looking, self._preparing):
            if task is not None:
                task.cancel()
                await asyncio.wait((task,))
        self._looking = self._preparing = None
        await self.planners.close()

    async def _prepare(self) -> None:
        try:
            await self.ready()
        except FlexcellError as error:
            # Nobody has asked yet; who asks hears of it.
            _log.warning("the planning scene cannot be made: %s", error)

    def _scene(self) -> LiveScene:
        if self._live is None:
            self._begin_with(self._make_scene())
        assert self._live is not None
        return self._live

    def _begin_with(self, live: LiveScene) -> None:
        live.remember(self._early_memo)
        live.refresh()
        self._live, self._told = live, live.revision
        self._publish(live)

    def _take_in(self, live: LiveScene) -> None:
        changed = live.refresh()
        if changed:
            self._tell(changed)

    def _tell(self, changed: set[str] | frozenset[str]) -> None:
        """Tell those who watch, and the bus where the scene itself is another."""
        for watcher in tuple(self._watchers):
            watcher(frozenset(changed))
        live = self._live
        if live is None or live.revision == self._told:
            return
        self._told = live.revision
        self._publish(live)

    def _publish(self, live: LiveScene) -> None:
        """Tell the cameras and the bus what is known."""
        if self._occupancy is not None:
            self._occupancy.know(live.whole())
        if self._topic is not None:
            self._topic.publish(live.state())

    async def _look_on(self) -> None:
        try:
            await self.ready()
            while True:
                await self._clock.sleep(LOOK_S)
                self._take_in(self._scene())
        except FlexcellError as error:
            # Who moves in it hears of the same from the planners and the port.
            _log.warning("the cell is no longer looked at: %s", error)

    def _end_watch(self, watcher: ChangeListener) -> None:
        if watcher in self._watchers:
            self._watchers.remove(watcher)
        if not self._watchers and self._looking is not None:
            self._looking.cancel()
            self._looking = None

    async def _read(self, request: ReadPlanningScene) -> PlanningSceneState:
        return await self._changed(lambda live: None)

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
        # Every motion from now on is looked at; the first one need not wait for who looks.
        self.planners.begin()
        return await self._changed(lambda live: live.attach(request.part, request.robot, request.link), {request.part})

    async def _detach(self, request: DetachPart) -> PlanningSceneState:
        return await self._changed(lambda live: live.detach(request.part), {request.part})

    async def _forget(self, request: ForgetOccupancy) -> PlanningSceneState:
        if self._occupancy is not None:
            self._occupancy.forget()
        return await self._changed(lambda live: None)

    async def _check(self, request: CheckCollision) -> CollisionReport:
        await self.ready()
        live = self._scene()
        self._take_in(live)
        scene = live.whole()
        try:
            arm = scene.arm(request.robot)
            joints = request.joints or arm.joints_rad
            return await self.planners.look(
                CollisionRequest(scene=scene, arm=arm.name, joints_rad=joints, occupancy=self.occupancy)
            )
        except FlexcellError as error:
            raise SkillFailed(error.message, where="cell", hint=error.hint) from error

    async def _changed(self, change: Callable[[LiveScene], None], names: set[str] | None = None) -> PlanningSceneState:
        await self.ready()
        live = self._scene()
        self._take_in(live)
        change(live)
        self._tell(names or set())
        return live.state()


def _nothing() -> None:
    """Do nothing."""

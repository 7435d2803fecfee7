"""Monitors the scene for one moving arm: whether its path is free, and what moves near it while it is at rest."""

from __future__ import annotations

from collections import deque
from collections.abc import Coroutine

import msgspec
import numpy as np

from engine.messages.sensing import OccupancyGrid
from robots.arm.execution.collision_prediction import PredictedCollision, predict_collision
from robots.arm.execution.motion_runner import MotionRunner
from robots.arm.scene_queries.path_planner import PathPlanner, PathSegment, describe_contacts
from robots.planning.request import PathCheck
from robots.planning.scene.planning_scene import OCCUPANCY
from robots.workspace.path_reservations import describe_names
from robots.workspace.workspace import Workspace

# An object that changed within this time counts as moving; within this distance it keeps a resting arm at rest.
_RECENT_S, _APART_M = 0.5, 0.08
# So far a hand at 1.6 m/s (ISO 13855) gets within two images at 15 Hz, their processing and the shortest stop: an arm
# that starts while voxels have been filled within this distance and time is touched in motion.
_APPROACH_S, _APPROACH_M = 0.2, 0.4
# Separation monitoring makes an arm creep while nothing in the scene changes.
_SEPARATION_LOOK_S = 0.25
# Fewer voxels are the edge of something at rest, which is hit in some images only.
_LEAST_FILLED = 4


class PathMonitor:
    """Checks the paths of one arm for one goal."""

    def __init__(self, runner: MotionRunner, planner: PathPlanner, workspace: Workspace) -> None:
        self._runner = runner
        self._planner = planner
        self._workspace = workspace
        self._changed_s: dict[str, float] = {}
        self._grids: deque[tuple[float, OccupancyGrid]] = deque()

    def note(self, names: frozenset[str]) -> None:
        """Record the names of objects that have just changed."""
        now_s = self._runner.clock.now_s()
        self._changed_s.update((name, now_s) for name in names)
        grid = self._workspace.occupancy
        if OCCUPANCY in names and grid is not None:
            self._grids.append((now_s, grid))
            # The last map before that time is what the later ones are compared with.
            while len(self._grids) > 1 and self._grids[1][0] < now_s - _APPROACH_S:
                self._grids.popleft()

    @property
    def unobserved_reason(self) -> str:
        """Why the scene is not observed; empty if it is."""
        return self._workspace.unobserved_reason

    @property
    def look_s(self) -> float | None:
        """The time after which a moving arm looks without a change of the scene, in seconds."""
        return _SEPARATION_LOOK_S if self._workspace.separation is not None else None

    def slow_reason(self, *, for_s: float) -> str:
        """Return who has made the arm creep or stand for so long by separation monitoring; empty if nobody has."""
        separation = self._workspace.separation
        return separation.slow_reason(self._runner.name, for_s=for_s) if separation is not None else ""

    @property
    def near_reason(self) -> str:
        """Who is so near that separation monitoring permits no motion; empty if nobody is."""
        separation = self._workspace.separation
        return separation.near_reason(self._runner.name) if separation is not None else ""

    @property
    def apart_m(self) -> float:
        """The distance from all that the cameras see which a new path should keep, 0 without separation monitoring."""
        separation = self._workspace.separation
        return separation.apart_m(self._runner.name) if separation is not None else 0.0

    def begin(self) -> None:
        """Take note that the arm begins to move."""
        if self._workspace.separation is not None:
            self._workspace.separation.begin(self._runner.name)

    async def ahead(self, segment: PathSegment, *, from_s: float) -> PredictedCollision | None:
        """Return the collision on the remaining path that the arm follows; None if it is free."""
        return await self._predict(self._planner.check(segment, from_s=from_s, margin_m=self._planner.margin_m))

    async def along(self, segment: PathSegment) -> PredictedCollision | None:
        """Return the collision on a path that was just planned; None if it is free."""
        return await self._predict(self._planner.confirm(segment))

    async def _predict(self, query: Coroutine[object, object, PathCheck]) -> PredictedCollision | None:
        if unavailable := self._workspace.planners.watch_unavailable_reason:
            # A moving arm would be notified too late; it waits at rest until a new process has started.
            query.close()
            return PredictedCollision(reason=f"path monitoring is not available: {unavailable}")
        return await predict_collision(self._workspace, query)

    async def rest_of(self, segment: PathSegment, *, from_s: float) -> str:
        """Return why a resting arm cannot follow its remaining path with the planned margin; empty if it can.

        Raises:
            RobotError: the planning process has ended.
        """
        check = await self._planner.check(segment, from_s=from_s, margin_m=segment.margin_m)
        return "" if check.blocked_at_s is None else describe_contacts(check.pairs)

    async def beside(self) -> str:
        """Return what moves near the resting arm and keeps it at rest; empty if nothing. Raises as `rest_of` does."""
        joints = self._runner.port.sample().position_rad
        filled = self._filled()
        if filled is not None:
            pairs = await self._planner.beside(joints, within_m=_APPROACH_M, occupancy=filled)
            if any(OCCUPANCY in pair for pair in pairs):
                return f"{describe_names(OCCUPANCY)} comes within {_APPROACH_M * 100:.0f} cm of the arm"
        now_s = self._runner.clock.now_s()
        recent = {name for name, at_s in self._changed_s.items() if now_s - at_s < _RECENT_S}
        if not recent:
            return ""
        pairs = await self._planner.beside(joints, within_m=_APART_M, occupancy=self._workspace.occupancy)
        for _, name in pairs:
            if name.partition("/")[0].partition("~")[0] in recent or name in recent:
                return f"{describe_names(name)} moves within {_APART_M * 100:.0f} cm of the arm"
        return ""

    def _filled(self) -> OccupancyGrid | None:
        """Return the voxels that have been filled within `_APPROACH_S`, as a map; None if there are hardly any."""
        since_s = self._runner.clock.now_s() - _APPROACH_S
        filled: OccupancyGrid | None = None
        for (_, before), (at_s, after) in zip(self._grids, list(self._grids)[1:], strict=False):
            if at_s >= since_s and len(before.occupied) == len(after.occupied):
                new = np.frombuffer(after.occupied, np.uint8) & ~np.frombuffer(before.occupied, np.uint8)
                if filled is not None:
                    new |= np.frombuffer(filled.occupied, np.uint8)
                filled = msgspec.structs.replace(after, occupied=new.tobytes())
        if filled is None or int.from_bytes(filled.occupied).bit_count() < _LEAST_FILLED:
            return None
        return filled

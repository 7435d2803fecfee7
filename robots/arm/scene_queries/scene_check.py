"""Checks trajectories of one arm for collisions in the current planning scene, by the collision options of a jog."""

from __future__ import annotations

import msgspec

from engine.errors import RobotError
from engine.skills.jogging import JogCollisionOptions
from robots.arm.scene_queries.path_planner import describe_contacts
from robots.planning.request import PairDistanceRequest, PairDistances, PathCheck, PathCheckRequest
from robots.planning.scene.planning_scene import NamePair, PlanningScene
from robots.port import Array, JointTrajectory
from robots.workspace.workspace import Workspace


class SceneCheck:
    """Checks trajectories of an arm.

    Args:
        arm: Name of the arm.
        workspace: Provides the scene, the occupancy and the planners.
        rule: Margin, and the objects that may be touched.
    """

    def __init__(self, arm: str, workspace: Workspace, *, rule: JogCollisionOptions) -> None:
        self._arm = arm
        self._workspace = workspace
        self._rule = rule

    async def check(self, trajectory: JointTrajectory, *, parting: tuple[NamePair, ...] = ()) -> PathCheck:
        """Return where a trajectory is blocked in the current scene, but for the pairs that it takes apart.

        Raises:
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        return await self._workspace.planners.check_path(
            PathCheckRequest(
                scene=await self._current(parting),
                arm=self._arm,
                trajectory=trajectory,
                from_s=0.0,
                occupancy=self._workspace.occupancy,
                margin_m=self._rule.margin_m,
            )
        )

    async def distances(self, rows: Array, pair: NamePair) -> PairDistances:
        """Return the distances of a pair at configurations (k, n) in the current scene; raises as `check` does."""
        return await self._workspace.planners.pair_distances(
            PairDistanceRequest(
                scene=await self._current(),
                arm=self._arm,
                rows_rad=tuple(tuple(row) for row in rows.tolist()),
                pair=pair,
                occupancy=self._workspace.occupancy,
                margin_m=self._rule.margin_m,
            )
        )

    async def _current(self, allowed: tuple[NamePair, ...] = ()) -> PlanningScene:
        await self._workspace.ready()
        scene = self._workspace.scene_for(self._arm)
        touched = (*((self._arm, name) for name in self._rule.may_touch), *allowed)
        return msgspec.structs.replace(scene, allowed=scene.allowed + touched) if touched else scene

    async def require_free(self, trajectory: JointTrajectory) -> None:
        """Return if the trajectory is collision-free.

        Raises:
            RobotError: a collision; the message names the objects.
            CellError: the scene is invalid.
        """
        self._workspace.require()
        try:
            await self._workspace.fresh()
            check = await self.check(trajectory)
        finally:
            self._workspace.release()
        if check.blocked_at_s is not None:
            share = check.blocked_at_s / max(trajectory.dt_s, trajectory.duration_s)
            raise RobotError(
                f"{describe_contacts(check.pairs)} after {share:.0%} of the step",
                where=self._arm,
                hint="choose another step, name the object in `scene.may_touch`, or give `scene.minded: false`",
            )

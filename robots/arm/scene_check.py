"""Asks of ways of one arm whether they are free in the planning scene as it is now, by the rule of a jog."""

from __future__ import annotations

import msgspec

from engine.errors import RobotError
from engine.skills.jogging import JogCollisionOptions
from robots.arm.path_planner import describe_contacts
from robots.planning.request import PathCheck, PathCheckRequest, SampledTrajectory
from robots.port import JointTrajectory
from robots.workspace.workspace import Workspace


class SceneCheck:
    """Checks ways of an arm.

    Args:
        arm: Its name.
        workspace: Whose scene, cameras and planners.
        rule: How far from what.
    """

    def __init__(self, arm: str, workspace: Workspace, *, rule: JogCollisionOptions) -> None:
        self._arm = arm
        self._workspace = workspace
        self._rule = rule

    @property
    def unobserved_reason(self) -> str:
        """Why nothing can be known of the scene; empty where it can."""
        stale = self._workspace.stale_reason
        return f"the occupancy map is not valid: {stale}" if stale else ""

    async def check(self, way: JointTrajectory) -> PathCheck:
        """Return where a way is blocked in the scene as it is now.

        Raises:
            RobotError: the process that looks has ended.
            CellError: the scene is wrong.
        """
        await self._workspace.ready()
        scene = self._workspace.scene_for(self._arm)
        touched = tuple((self._arm, name) for name in self._rule.may_touch)
        return await self._workspace.planners.check_path(
            PathCheckRequest(
                scene=msgspec.structs.replace(scene, allowed=scene.allowed + touched) if touched else scene,
                arm=self._arm,
                way=SampledTrajectory.of(way),
                from_s=0.0,
                occupancy=self._workspace.occupancy,
                margin_m=self._rule.margin_m,
            )
        )

    async def require_free(self, way: JointTrajectory) -> None:
        """Return when a way was found free.

        Raises:
            RobotError: it is not; the message names what would touch.
            CellError: the scene is wrong.
        """
        self._workspace.require()
        try:
            await self._workspace.fresh()
            check = await self.check(way)
        finally:
            self._workspace.release()
        if check.blocked_at_s is not None:
            share = check.blocked_at_s / max(way.dt_s, way.dt_s * (len(way.position_rad) - 1))
            raise RobotError(
                f"{describe_contacts(check.pairs)} after {share:.0%} of the step",
                where=self._arm,
                hint="step elsewhere, name it in `scene.may_touch`, or give `scene.minded: false`",
            )

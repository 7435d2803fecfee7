"""Checks unplanned trajectories of one arm for collisions of its attached parts."""

from __future__ import annotations

from engine.errors import PathBlocked
from robots.arm.scene_queries.path_planner import describe_contacts
from robots.planning.request import AttachedPartCheckRequest, PathCheck
from robots.port import JointTrajectory
from robots.workspace.workspace import Workspace


class AttachedPartGuard:
    """Checks trajectories of an arm in the planning scene at their start.

    Args:
        arm: Name of the arm.
        workspace: Provides the scene and the planners.
    """

    def __init__(self, arm: str, workspace: Workspace) -> None:
        self._arm = arm
        self._workspace = workspace

    async def check(self, trajectory: JointTrajectory) -> PathCheck:
        """Return where an attached part is blocked on the trajectory; free at once without any.

        Raises:
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        workspace = self._workspace
        free = PathCheck(blocked_at_s=None, pairs=(), looked_s=trajectory.duration_s)
        if not workspace.holds(self._arm):
            return free
        await workspace.ready()
        scene = workspace.attached_check_scene_for(self._arm)
        if scene is None:
            return free
        request = AttachedPartCheckRequest(scene=scene, arm=self._arm, trajectory=trajectory)
        return await workspace.planners.check_attached_parts(request)

    async def require_free(self, trajectory: JointTrajectory) -> None:
        """Return when the attached parts have only allowed contacts along the trajectory.

        Raises:
            PathBlocked: a collision; the message names both objects and the position on the trajectory.
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        check = await self.check(trajectory)
        if check.blocked_at_s is not None:
            share = check.blocked_at_s / trajectory.duration_s if trajectory.duration_s else 0.0
            raise PathBlocked(
                f"{describe_contacts(check.pairs)} after {share:.0%} of the path",
                where=self._arm,
                hint="choose another path or goal, or allow this contact",
            )

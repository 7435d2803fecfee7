"""Asks of ways of one arm that nobody looked for whether what the arm holds would touch anything on them."""

from __future__ import annotations

from engine.errors import PathBlocked
from robots.arm.path_planner import describe_contacts
from robots.planning.request import AttachedPartCheckRequest, SampledTrajectory
from robots.port import JointTrajectory
from robots.workspace.workspace import Workspace


class AttachedPartGuard:
    """Checks ways of an arm, in the planning scene as it is when they begin.

    Args:
        arm: Its name.
        workspace: Whose scene and planners.
    """

    def __init__(self, arm: str, workspace: Workspace) -> None:
        self._arm = arm
        self._workspace = workspace

    async def require_free(self, way: JointTrajectory) -> None:
        """Return when what the arm holds touches nothing on the way but what it may; at once where it holds nothing.

        Raises:
            PathBlocked: it does; the message names both and says where.
            RobotError: the process that looks has ended.
            CellError: the scene is wrong.
        """
        workspace = self._workspace
        if not workspace.holds(self._arm):
            return
        await workspace.ready()
        scene = workspace.attached_check_scene_for(self._arm)
        if scene is None:
            return
        request = AttachedPartCheckRequest(scene=scene, arm=self._arm, way=SampledTrajectory.of(way))
        check = await workspace.planners.check_attached_parts(request)
        if check.blocked_at_s is not None:
            share = check.blocked_at_s / way.duration_s if way.duration_s else 0.0
            raise PathBlocked(
                f"{describe_contacts(check.pairs)} after {share:.0%} of the way",
                where=self._arm,
                hint="choose another way or another place, or allow the two to touch",
            )

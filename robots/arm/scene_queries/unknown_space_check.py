"""Checks whether a planned trajectory of one arm passes through space that the cameras have not seen."""

from __future__ import annotations

from robots.planning.request import PlanRefusal
from robots.planning.swept_space import SweptSpace, SweptSpaceRequest
from robots.port import JointTrajectory
from robots.workspace.unknown_space import describe_unknown
from robots.workspace.workspace import LOOK_S, Workspace

_LOOK_FIRST_S = 3.0
UNKNOWN_SPACE_HINT = (
    "clear the view of the cameras, wait until they see it, choose another path, "
    "or set `unknown_space` of the cell's `occupancy`"
)


class UnknownSpaceCheck:
    """Asks the planners of a workspace for the unknown space on trajectories of one arm.

    Args:
        arm: Name of the arm.
        workspace: Provides the scene, the observed space, the rule and the planners.
    """

    def __init__(self, arm: str, workspace: Workspace) -> None:
        self._arm = arm
        self._workspace = workspace

    async def on(self, trajectory: JointTrajectory) -> SweptSpace | None:
        """Return the unknown space on a trajectory; None without any, or where the cell accepts it.

        Raises:
            RobotError: the planning process has ended.
            CellError: the scene is invalid.
        """
        workspace, rule = self._workspace, self._workspace.unknown_space
        observed = workspace.observed
        if rule.policy == "accept" or observed is None:
            return None
        swept = await workspace.planners.swept_space(
            SweptSpaceRequest(
                scene=workspace.scene_for(self._arm),
                arm=self._arm,
                trajectory=trajectory,
                observed=observed,
                regions=rule.regions,
                near_m=rule.near_m,
            )
        )
        return swept if swept.unknown_m3 > 0.0 else None

    async def once_observed(self, trajectory: JointTrajectory) -> SweptSpace | None:
        """Return what is still unknown after the cameras have had some seconds to see it; raises as `on` does."""
        swept = await self.on(trajectory)
        observed, waited = self._workspace.observed, 0
        while swept is not None and waited < _LOOK_FIRST_S / LOOK_S:
            await self._workspace.pause()
            waited += 1
            if self._workspace.observed is not observed:
                observed = self._workspace.observed
                swept = await self.on(trajectory)
        return swept

    def refusal(self, swept: SweptSpace, trajectory: JointTrajectory) -> PlanRefusal:
        """Return the refusal of a trajectory through unknown space."""
        message = describe_unknown(
            swept, arm=self._arm, duration_s=trajectory.duration_s, statuses=self._workspace.camera_statuses
        )
        return PlanRefusal(reason="unknown_space", message=message, hint=UNKNOWN_SPACE_HINT)

"""scene.RemoveObstacle: removes an obstacle from the planning scene."""

from __future__ import annotations

from typing import ClassVar

from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, ObstacleName


class RemoveObstacle(State, frozen=True, kw_only=True):
    """Remove an obstacle that `scene.PutObstacle` added; waiting arms resume. No effect if there is none."""

    state_name: ClassVar[str] = "scene.RemoveObstacle"
    outcomes: ClassVar[tuple[str, ...]] = ("removed", "failed")
    success: ClassVar[tuple[str, ...]] = ("removed",)

    name: ObstacleName

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell."""
        request = planning_scene.RemoveObstacle(name=self.name)
        what = f"obstacle {self.name} was not removed from the planning scene"
        return await call_or_fail(ctx, request, to=CELL, done="removed", what=what, kind=self.state_name)

"""scene.RemoveObstacle: takes an obstacle out of the planning scene."""

from __future__ import annotations

from typing import ClassVar

from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, ObstacleName


class RemoveObstacle(State, frozen=True, kw_only=True):
    """Take away an obstacle that `scene.PutObstacle` put; waiting arms go on. One already gone is no failure."""

    state_name: ClassVar[str] = "scene.RemoveObstacle"
    outcomes: ClassVar[tuple[str, ...]] = ("removed", "failed")
    success: ClassVar[tuple[str, ...]] = ("removed",)

    name: ObstacleName

    async def run(self, ctx: Context) -> Outcome:
        """Ask the cell."""
        request = planning_scene.RemoveObstacle(name=self.name)
        what = f"obstacle {self.name} was not taken out of the scene"
        return await call_or_fail(ctx, request, to=CELL, done="removed", what=what, kind=self.state_name)

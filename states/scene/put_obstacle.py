"""scene.PutObstacle: puts an obstacle into the planning scene."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.document.placement import Placement
from engine.messages.shapes import Obstacle
from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, NewObstacleName
from states.scene.shape_parameter_types import Lengths, ShapeName, shape_of


class PutObstacle(State, frozen=True, kw_only=True):
    """Let arms keep off a box, cylinder, sphere or capsule, from now on; it takes the place of one of the same name.

    Arms under way go around it. It is in the planning scene alone: nothing appears in the world.
    """

    state_name: ClassVar[str] = "scene.PutObstacle"
    outcomes: ClassVar[tuple[str, ...]] = ("put", "failed")
    success: ClassVar[tuple[str, ...]] = ("put",)

    name: NewObstacleName
    shape: ShapeName = "box"
    size_m: Lengths
    at: Annotated[Placement, Meta(description="Where its centre is in the world: `{xyz, rpy}`")]

    def __post_init__(self) -> None:
        shape_of(self.shape, self.size_m)

    async def run(self, ctx: Context) -> Outcome:
        """Ask the cell."""
        obstacle = Obstacle.of(self.name, shape_of(self.shape, self.size_m), self.at.pose())
        request = planning_scene.PutObstacle(obstacle=obstacle)
        what = f"obstacle {self.name} was not put into the scene"
        return await call_or_fail(ctx, request, to=CELL, done="put", what=what, kind=self.state_name)

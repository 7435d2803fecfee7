"""scene.PutObstacle: adds an obstacle to the planning scene."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.document import Placement
from engine.messages.shapes import Obstacle
from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, NewObstacleName
from states.scene.shape_parameter_types import Lengths, ShapeName, shape_of


class PutObstacle(State, frozen=True, kw_only=True):
    """Add a box, cylinder, sphere or capsule to the planning scene; it replaces an obstacle of the same name.

    Moving arms replan around it. It exists in the planning scene only, not in the simulated world.
    """

    state_name: ClassVar[str] = "scene.PutObstacle"
    outcomes: ClassVar[tuple[str, ...]] = ("put", "failed")
    success: ClassVar[tuple[str, ...]] = ("put",)

    name: NewObstacleName
    shape: ShapeName = "box"
    size_m: Lengths
    at: Annotated[Placement, Meta(description="Pose of its centre in the world: `{xyz, rpy}`")]

    def __post_init__(self) -> None:
        shape_of(self.shape, self.size_m)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell."""
        obstacle = Obstacle.of(self.name, shape_of(self.shape, self.size_m), self.at.pose())
        request = planning_scene.PutObstacle(obstacle=obstacle)
        what = f"obstacle {self.name} was not added to the planning scene"
        return await call_or_fail(ctx, request, to=CELL, done="put", what=what, kind=self.state_name)

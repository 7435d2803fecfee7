"""scene.ForgetOccupancy: clears the occupancy map."""

from __future__ import annotations

from typing import ClassVar

from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL


class ForgetOccupancy(State, frozen=True, kw_only=True):
    """Clear the occupancy map of the cameras: hidden space counts as free; visible obstacles are mapped again."""

    state_name: ClassVar[str] = "scene.ForgetOccupancy"
    outcomes: ClassVar[tuple[str, ...]] = ("forgotten", "failed")
    success: ClassVar[tuple[str, ...]] = ("forgotten",)

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell."""
        what = "the occupancy map was not cleared"
        request = planning_scene.ForgetOccupancy()
        return await call_or_fail(ctx, request, to=CELL, done="forgotten", what=what, kind=self.state_name)

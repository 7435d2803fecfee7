"""scene.ForgetOccupancy: empties the map of what the cameras have seen."""

from __future__ import annotations

from typing import ClassVar

from engine.skills import planning_scene
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL


class ForgetOccupancy(State, frozen=True, kw_only=True):
    """Forget what the cameras have seen: places that are hidden now count as free. What is in view is seen again."""

    state_name: ClassVar[str] = "scene.ForgetOccupancy"
    outcomes: ClassVar[tuple[str, ...]] = ("forgotten", "failed")
    success: ClassVar[tuple[str, ...]] = ("forgotten",)

    async def run(self, ctx: Context) -> Outcome:
        """Ask the cell."""
        what = "what the cameras have seen was not forgotten"
        request = planning_scene.ForgetOccupancy()
        return await call_or_fail(ctx, request, to=CELL, done="forgotten", what=what, kind=self.state_name)

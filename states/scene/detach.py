"""scene.Detach: detaches a part of the planning scene from its arm."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.planning_scene import DetachPart
from engine.state import Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.scene.scene_parameter_types import CELL, CarriedName


class Detach(State, frozen=True, kw_only=True):
    """Detach a part from its arm: it stays in the scene at its current pose. No effect if the part is not attached."""

    state_name: ClassVar[str] = "scene.Detach"
    outcomes: ClassVar[tuple[str, ...]] = ("detached", "failed")
    success: ClassVar[tuple[str, ...]] = ("detached",)

    part: CarriedName

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell."""
        what = f"part {self.part} was not detached"
        return await call_or_fail(
            ctx, DetachPart(part=self.part), to=CELL, done="detached", what=what, kind=self.state_name
        )

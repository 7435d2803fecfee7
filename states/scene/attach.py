"""scene.Attach: attaches a part of the planning scene to an arm."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.planning_scene import AttachPart, DetachPart
from engine.state import ActivationRecord, Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName
from states.scene.scene_parameter_types import CELL, CarriedName


class Attach(State, frozen=True, kw_only=True):
    """Attach a part to the arm that holds it, at its current pose relative to the tool; planning includes it.

    The part may touch the tool, and its support until it is lifted.
    """

    state_name: ClassVar[str] = "scene.Attach"
    outcomes: ClassVar[tuple[str, ...]] = ("attached", "failed")
    success: ClassVar[tuple[str, ...]] = ("attached",)

    part: CarriedName
    robot: RobotName
    link: Annotated[
        str,
        Meta(
            description="Link that holds the part; the tool link by default",
            extra_json_schema={"cell_name": "link", "of": "robot"},
        ),
    ] = ""

    async def run(self, ctx: Context) -> Outcome:
        """Call the service of the cell."""
        request = AttachPart(part=self.part, robot=self.robot, link=self.link)
        what = f"part {self.part} was not attached to {self.robot}"
        return await call_or_fail(ctx, request, to=CELL, done="attached", what=what, kind=self.state_name)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Detach the part at its current pose; it is not attached again to an arm that held it before."""
        if done.outcome != "failed":
            await ctx.call(DetachPart(part=self.part), to=CELL)

"""scene.Attach: lets a part of the planning scene move along with an arm."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.skills.planning_scene import AttachPart, DetachPart
from engine.state import ActivationRecord, Context, Outcome, State
from states.call_or_fail import call_or_fail
from states.motion.motion_target import RobotName
from states.scene.scene_parameter_types import CELL, CarriedName


class Attach(State, frozen=True, kw_only=True):
    """Plan with a part as with a piece of the arm that holds it, from where it is relative to the tool now.

    It may touch the tool, and what it lies on until it is lifted.
    """

    state_name: ClassVar[str] = "scene.Attach"
    outcomes: ClassVar[tuple[str, ...]] = ("attached", "failed")
    success: ClassVar[tuple[str, ...]] = ("attached",)

    part: CarriedName
    robot: RobotName
    link: Annotated[
        str,
        Meta(
            description="The link that holds it; the tool's by default",
            extra_json_schema={"cell_name": "link", "of": "robot"},
        ),
    ] = ""

    async def run(self, ctx: Context) -> Outcome:
        """Ask the cell."""
        request = AttachPart(part=self.part, robot=self.robot, link=self.link)
        what = f"part {self.part} was not attached to {self.robot}"
        return await call_or_fail(ctx, request, to=CELL, done="attached", what=what, kind=self.state_name)

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Let the part stay where it is again; another arm that held it before does not get it back."""
        if done.outcome != "failed":
            await ctx.call(DetachPart(part=self.part), to=CELL)

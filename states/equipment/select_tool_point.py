"""equipment.SelectToolPoint: sets one of the tool centre points of the tool that an arm has taken."""

from __future__ import annotations

from typing import ClassVar

from engine.skills.arm_target import StoredTargets, ToolChange
from engine.skills.tool_changer import LockTool
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.equipment.tool_parameter_types import ChangeableToolName, ToolChangerName, ToolPointName
from states.equipment.tool_place import require_on


class SelectToolPoint(State, frozen=True, kw_only=True):
    """Set a tool centre point of the tool that is on, by its name; `missing` when the arm has not this tool."""

    state_name: ClassVar[str] = "equipment.SelectToolPoint"
    skills: ClassVar[Skills] = (LockTool,)
    outcomes: ClassVar[tuple[str, ...]] = ("selected", "missing", "failed")
    success: ClassVar[tuple[str, ...]] = ("selected",)

    robot: ToolChangerName
    tool: ChangeableToolName
    tcp: ToolPointName

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ToolChange, ...]:
        """Return the change of the tool centre point, which applies to all later pose targets."""
        return (ToolChange(robot=self.robot),)

    async def run(self, ctx: Context) -> Outcome:
        """Lock the tool that is locked: the lock stays as it is."""
        if ended := await require_on(ctx, self.robot, self.tool):
            return Outcome("missing", cause=ended.cause)
        goal = LockTool(tool=self.tool, tcp=self.tcp)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded" and end.result is not None and end.result.ended == "locked":
            return Outcome("selected")
        what = f"{self.robot} did not set the tool centre point {self.tcp}"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

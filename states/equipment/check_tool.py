"""equipment.CheckTool: checks whether an arm still has its tool."""

from __future__ import annotations

from typing import ClassVar

from engine.cause_chain import wrap_cause
from engine.skills.tool_changer import ReadToolChanger
from engine.state import Context, Outcome, Skills, State
from states.equipment.tool_parameter_types import ChangeableToolName, ToolChangerName
from states.equipment.tool_place import require_on


class CheckTool(State, frozen=True, kw_only=True):
    """Check by the sensors of the tool changer whether an arm still has a tool; `lost` also when it has another one."""

    state_name: ClassVar[str] = "equipment.CheckTool"
    skills: ClassVar[Skills] = (ReadToolChanger,)
    outcomes: ClassVar[tuple[str, ...]] = ("on", "lost")
    success: ClassVar[tuple[str, ...]] = ("on",)
    observes: ClassVar[bool] = True

    robot: ToolChangerName
    tool: ChangeableToolName

    async def run(self, ctx: Context) -> Outcome:
        """Read the tool changer."""
        ended = await require_on(ctx, self.robot, self.tool)
        if ended is None:
            return Outcome("on")
        message = f"{self.robot} lost {self.tool}"
        return Outcome("lost", cause=wrap_cause(message, ended.cause, where=ctx.path, kind=self.state_name))

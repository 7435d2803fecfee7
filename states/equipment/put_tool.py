"""equipment.PutTool: puts the tool of a tool changer back into its hanger."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.errors import Cause
from engine.skills.arm_target import StoredTargets, ToolChange
from engine.skills.motion import CartLinTask, Speed
from engine.skills.planning import BlockedPathTimeout, Margin, MoveFree
from engine.skills.tool_changer import DescribeTool, ReadToolChanger, ReleaseTool, ToolDescription
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.equipment.check_tool import CheckTool
from states.equipment.tool_parameter_types import ChangeableToolName, ToolChangerName
from states.equipment.tool_place import docked_tcp, require_on, straight_out, tool_approach, who_is_at
from states.manipulation.approach import Approach
from states.manipulation.approach_line import ApproachDirection, LineLength, LineSpeed, retreat_vector
from states.manipulation.step_sequence import SequenceEnd, SequenceStep


class PutTool(State, frozen=True, kw_only=True):
    """Move the tool to its place in the hanger, open the lock, retreat, and look whether the tool has stayed there.

    Afterwards the arm has the tool centre point and the load of the bare flange. `missing` when the arm has not this
    tool, or loses it on the way, or it does not stay; `occupied` when something else is in its place; `not_released`
    when the sensor of the lock tells that it still has the tool. In `unreachable` and `blocked` it is still locked. A
    tool that hangs in its place already, while the arm has none, is `put`; an arm that is still there leaves it.
    """

    state_name: ClassVar[str] = "equipment.PutTool"
    skills: ClassVar[Skills] = (ReleaseTool, MoveFree, CartLinTask)
    outcomes: ClassVar[tuple[str, ...]] = (
        *("put", "missing", "occupied", "not_released", "unreachable", "blocked", "failed"),
    )
    success: ClassVar[tuple[str, ...]] = ("put",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"put": ("reason",)}

    robot: ToolChangerName
    tool: ChangeableToolName
    approach: ApproachDirection = None
    approach_m: LineLength = 0.15
    speed: Speed = 0.3
    line_speed_m_s: LineSpeed = 0.1
    margin_m: Margin = 0.0
    patience_s: BlockedPathTimeout = 60.0

    def __post_init__(self) -> None:
        if self.approach is not None and not any(self.approach):
            raise ValueError("`approach` must not be a zero vector")

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    def arm_targets(self, stored: StoredTargets) -> tuple[ToolChange, ...]:
        """Return the change of the tool centre point, which applies to all later pose targets."""
        return (ToolChange(robot=self.robot),)

    async def run(self, ctx: Context) -> Outcome:
        """Run the steps."""
        ended = await self._put(ctx)
        if ended is None:
            return Outcome("put")
        return ended.under(f"{self.robot} did not put {self.tool} back", where=ctx.path, kind=self.state_name)

    async def _put(self, ctx: Context) -> SequenceEnd | None:
        description = await ctx.call(DescribeTool(tool=self.tool), to=self.robot)
        docked = description.docked
        approach = self._approach(retreat_vector(docked, docked, self.approach, self.approach_m))
        at_place, other = await who_is_at(ctx, description, self.tool)
        changer = await ctx.call(ReadToolChanger(), to=self.robot)
        if at_place and not changer.tool:
            return await straight_out(ctx, approach, docked)
        if ended := await require_on(ctx, self.robot, self.tool):
            return ended
        if other:
            return SequenceEnd("occupied", Cause(message=f"{other} is in the place of {self.tool}", where="cell/parts"))
        target = docked_tcp(description, changer.tcp)
        check = SequenceStep(CheckTool(robot=self.robot, tool=self.tool), {"lost": "missing"})
        reached = await approach.to(ctx, [target], before=[check])
        if isinstance(reached, SequenceEnd):
            return reached
        ended = await self._release(ctx) or await straight_out(ctx, approach, docked)
        return ended or await self._stayed(ctx, description)

    def _approach(self, out_m: tuple[float, float, float]) -> Approach:
        return tool_approach(
            self.robot,
            self.tool,
            out_m=out_m,
            speed=self.speed,
            line_speed_m_s=self.line_speed_m_s,
            margin_m=self.margin_m,
            patience_s=self.patience_s,
            kind=self.state_name,
        )

    async def _release(self, ctx: Context) -> SequenceEnd | None:
        goal = ReleaseTool()
        end = await ctx.perform(goal, to=self.robot)
        if end.status != "succeeded" or end.result is None:
            what = f"{self.robot} did not release {self.tool}"
            cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
            return SequenceEnd("failed", cause)
        if end.result.ended == "released":
            return None
        return SequenceEnd("not_released", Cause(message=end.result.reason, where=goal.address(self.robot)))

    async def _stayed(self, ctx: Context, description: ToolDescription) -> SequenceEnd | None:
        at_place, _ = await who_is_at(ctx, description, self.tool)
        if at_place:
            return None
        return SequenceEnd("missing", Cause(message=f"{self.tool} did not stay in its place", where="cell/parts"))

"""equipment.TakeTool: takes a tool from its hanger with a tool changer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.errors import Cause
from engine.skills.arm_target import StoredTargets, ToolChange
from engine.skills.motion import CartLinTask, Speed
from engine.skills.planning import BlockedPathTimeout, Margin, MoveFree
from engine.skills.tool_changer import DescribeTool, LockTool, LockToolResult, ReadToolChanger, ToolDescription
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.equipment.tool_parameter_types import ChangeableToolName, FirstToolPointName, ToolChangerName
from states.equipment.tool_place import docked_tcp, require_on, straight_out, tool_approach, who_is_at
from states.manipulation.approach import Approach
from states.manipulation.approach_line import ApproachDirection, LineLength, LineSpeed, retreat_vector
from states.manipulation.step_sequence import SequenceEnd, SequenceStep, run_steps
from states.motion.set_tool_frame import SetToolFrame

_FAILED = {"failed": "failed"}
_RETREATS = ("missing", "not_locked")


class TakeTool(State, frozen=True, kw_only=True):
    """Move to the place of a tool, dock, lock, and lift the tool out.

    Tool centre point, load and shapes of the arm are those of the tool as soon as the lock has it.

    `missing` when the tool is not in its place, no plate is felt at the face, another tool is, or it comes off;
    `occupied` when the arm has another tool; `not_locked` when the sensor of the lock does not tell that it has the
    tool. After `missing` and `not_locked` at the place the arm has retreated, with the lock open. A tool that is on
    already is lifted out.
    """

    state_name: ClassVar[str] = "equipment.TakeTool"
    skills: ClassVar[Skills] = (LockTool, MoveFree, CartLinTask)
    outcomes: ClassVar[tuple[str, ...]] = (
        *("taken", "missing", "occupied", "not_locked", "unreachable", "blocked", "failed"),
    )
    success: ClassVar[tuple[str, ...]] = ("taken",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"taken": ("reason",)}

    robot: ToolChangerName
    tool: ChangeableToolName
    tcp: FirstToolPointName = ""
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
        ended = await self._take(ctx)
        if ended is None:
            return Outcome("taken")
        return ended.under(f"{self.robot} did not take {self.tool}", where=ctx.path, kind=self.state_name)

    async def _take(self, ctx: Context) -> SequenceEnd | None:
        on = (await ctx.call(ReadToolChanger(), to=self.robot)).tool
        if on not in ("", self.tool):
            return _end("occupied", f"{self.robot} has {on}", where=self.robot)
        description = await ctx.call(DescribeTool(tool=self.tool), to=self.robot)
        docked = description.docked
        approach = self._approach(retreat_vector(docked, docked, self.approach, self.approach_m))
        if not on and (ended := await self._dock(ctx, description, approach)):
            return ended
        if (ended := await self._lock(ctx)) is not None:
            return (await straight_out(ctx, approach, docked) or ended) if ended.outcome in _RETREATS else ended
        tcp = self.tcp or next(iter(description.tool.tcps))
        lifted = await straight_out(ctx, approach, docked_tcp(description, tcp))
        return lifted or await require_on(ctx, self.robot, self.tool)

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

    async def _dock(self, ctx: Context, description: ToolDescription, approach: Approach) -> SequenceEnd | None:
        at_place, other = await who_is_at(ctx, description, self.tool)
        if not at_place:
            reason = f"{other} is in the place of {self.tool}" if other else f"{self.tool} is not in its place"
            return _end("missing", reason, where="cell/parts")
        bare = SetToolFrame(robot=self.robot)
        if ended := await run_steps(ctx, [SequenceStep(bare, _FAILED)]):
            return ended
        reached = await approach.to(ctx, [description.docked])
        return reached if isinstance(reached, SequenceEnd) else None

    async def _lock(self, ctx: Context) -> SequenceEnd | None:
        goal = LockTool(tool=self.tool, tcp=self.tcp)
        end = await ctx.perform(goal, to=self.robot)
        result: LockToolResult | None = end.result
        if end.status != "succeeded" or result is None:
            what = f"{self.robot} did not lock {self.tool}"
            cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
            return SequenceEnd("failed", cause)
        if result.ended == "locked":
            return None
        outcome = "not_locked" if result.ended == "not_locked" else "missing"
        return _end(outcome, result.reason, where=goal.address(self.robot))


def _end(outcome: str, reason: str, *, where: str) -> SequenceEnd:
    return SequenceEnd(outcome, Cause(message=reason, where=where))

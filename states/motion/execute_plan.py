"""motion.ExecutePlan: executes a path that was planned before."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.skills import planning
from engine.skills.planning import BlockedPathTimeout, KeepOrientation, Margin, PlannedMotion, PlannerName, PlanningTime
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName
from states.motion.planned_motion_result import inner_cause_text, is_blocked_timeout
from states.motion.planned_motion_target import WatchPath


class ExecutePlan(State, frozen=True, kw_only=True):
    """Execute the path `plan` of `motion.PlanMotion`; the arm must stand at its start.

    If the planning scene changes during the motion, the arm replans as in `motion.MoveFree`, with the planner, margin
    and orientation given here. `blocked` and `failed` write the `reason`.
    """

    state_name: ClassVar[str] = "motion.ExecutePlan"
    skills: ClassVar[Skills] = (planning.ExecutePlan,)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "blocked", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"reached": ("reason",)}

    robot: RobotName
    patience_s: BlockedPathTimeout = 60.0
    watch: WatchPath = True
    planner: PlannerName = "fast"
    time_s: PlanningTime = 1.0
    margin_m: Margin = 0.0
    keep_orientation: KeepOrientation | None = None

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context, *, plan: PlannedMotion) -> Outcome:
        """Send the goal and judge its end."""
        options = planning.PlanOptions(
            planner=self.planner,
            time_s=self.time_s,
            margin_m=self.margin_m,
            keep_orientation=self.keep_orientation,
            speed=plan.speed,
        )
        adaptation = planning.Adaptation(watch=self.watch, patience_s=self.patience_s)
        goal = planning.ExecutePlan(plan=plan, adaptation=adaptation, options=options)
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded":
            return Outcome("reached")
        what = f"{self.robot} did not execute its planned path to the end"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("blocked" if is_blocked_timeout(end) else "failed", {"reason": inner_cause_text(cause)}, cause)

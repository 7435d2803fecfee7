"""The collision-free motion skills of one arm: plan a way, go one, find one and go it, around what comes into it."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import msgspec
import numpy as np

from engine.bus import ActiveGoal, SkillBus
from engine.errors import GoalRejected, RobotError, SkillFailed
from engine.messages import Pose
from engine.skills.planning import (
    Adaptation,
    ExecutePlan,
    FreeMotionFeedback,
    FreeMotionResult,
    MotionPhase,
    MotionTarget,
    MoveFree,
    PlanFeedback,
    PlanMotion,
    PlannedMotion,
    PlanOptions,
)
from robots.arm.adaptive_motion import AdaptiveMotion
from robots.arm.adaptive_motion_report import AdaptiveMotionReport
from robots.arm.attached_part_guard import AttachedPartGuard
from robots.arm.motion_runner import MotionRunner
from robots.arm.path_planner import TRANSIENT_REASONS, PathPlanner, PathSegment, PlanningGoal, describe_contacts
from robots.arm.path_preview import PathPreviewPublisher, compute_tool_path, sample_trajectory
from robots.arm.tool_frames import WORLD
from robots.arm.validate_numbers import are_numbers
from robots.planning.request import JointGoal, PathGoal, PlanRefusal, PoseGoal
from robots.port import Array
from robots.port.settings import NO_FRAME
from robots.supervise_goal import FEEDBACK_S
from robots.workspace.workspace import Workspace

# A scene may change while a way is looked for; the third way that is blocked when it is found is given up.
_TRIES = 3
_AT_START_RAD = 0.01


class FreeMotions:
    """Answers PlanMotion, ExecutePlan and MoveFree, and publishes `<arm>/planned_path`."""

    def __init__(self, runner: MotionRunner, workspace: Workspace) -> None:
        self._runner = runner
        self._workspace = workspace
        self._preview = PathPreviewPublisher(runner)
        self._carry = AttachedPartGuard(runner.name, workspace)

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name."""
        name = self._runner.name
        bus.advertise_action(PlanMotion, self._plan_motion, namespace=name)
        bus.advertise_action(ExecutePlan, self._execute_plan, namespace=name, exclusive=name)
        bus.advertise_action(MoveFree, self._move_free, namespace=name, exclusive=name)
        self._preview.register(bus)

    async def _plan_motion(self, goal: PlanMotion, handle: ActiveGoal[PlanFeedback]) -> PlannedMotion:
        runner = self._runner
        start = self._joints(goal.start, handle) if goal.start else runner.port.sample().desired_rad
        finder = self._finder(self._goal(goal.target, handle), goal.options)
        handle.accept()
        began_s = runner.clock.now_s()
        finding = asyncio.ensure_future(self._seen(lambda: finder.find(np.array(start))))
        try:
            while not (await asyncio.wait((finding,), timeout=FEEDBACK_S))[0]:
                handle.feedback(PlanFeedback(elapsed_s=runner.clock.now_s() - began_s))
        finally:
            finding.cancel()
        found = finding.result()
        if isinstance(found, PlanRefusal):
            raise SkillFailed(found.message, where=handle.address, hint=found.hint or None)
        self._preview.show(found.trajectory, state="proposed")
        return self._planned(found, goal.options, planning_s=runner.clock.now_s() - began_s)

    async def _move_free(self, goal: MoveFree, handle: ActiveGoal[FreeMotionFeedback]) -> FreeMotionResult:
        finder = self._finder(self._goal(goal.target, handle), goal.options)
        return await self._go(finder, finder, goal.adaptation, handle)

    async def _execute_plan(self, goal: ExecutePlan, handle: ActiveGoal[FreeMotionFeedback]) -> FreeMotionResult:
        plan = goal.plan
        if plan.robot != self._runner.name:
            raise GoalRejected(f"this is a plan for {plan.robot}", where=handle.address, hint="plan for this arm")
        if len(plan.waypoints) < 1:
            raise GoalRejected("this plan has no waypoints", where=handle.address, hint="plan again")
        rows = tuple(tuple(self._joints(row, handle).tolist()) for row in plan.waypoints)
        gap = np.abs(np.array(rows[0]) - self._runner.port.sample().desired_rad)
        if gap.max() > _AT_START_RAD:
            joint = self._runner.model.arm_joints[int(np.argmax(gap))]
            raise GoalRejected(
                f"the plan does not start where the arm stands: {joint} is {gap.max():.3f} rad away",
                where=handle.address,
                hint="plan again from here",
            )
        options = msgspec.structs.replace(goal.options, speed=plan.speed)
        onward = self._finder(JointGoal(joints_rad=(rows[-1],)), options)
        first = self._finder(PathGoal(waypoints_rad=rows), options)
        return await self._go(first, onward, goal.adaptation, handle)

    async def _go(
        self, first: PathPlanner, onward: PathPlanner, adaptation: Adaptation, handle: ActiveGoal[FreeMotionFeedback]
    ) -> FreeMotionResult:
        """Find the first way, or reject the goal; go it, and what `onward` finds where it is blocked."""
        runner, workspace = self._runner, self._workspace
        handle.feedback(self._feedback("planning"))
        workspace.require()
        try:
            leg = await runner.planned(handle, lambda start: self._first_leg(first, onward, start, adaptation))
            shown = _MotionDisplay(
                lambda phase, motion: handle.feedback(self._feedback(phase, motion)), runner, self._preview
            )

            def start() -> AdaptiveMotion:
                motion = AdaptiveMotion(
                    leg, runner=runner, finder=onward, workspace=workspace, adaptation=adaptation, shown=shown
                )
                shown.motion = motion
                return motion

            ended = await runner.carry_out(
                start, handle, lambda motion: handle.feedback(self._feedback(motion.phase, motion)), left=shown.result
            )
            return shown.result(ended.duration_s)
        finally:
            workspace.release()
            self._preview.clear()

    async def _first_leg(
        self, first: PathPlanner, onward: PathPlanner, start: Array, adaptation: Adaptation
    ) -> PathSegment | str:
        """Return a way that is free when it is returned, or why to wait for one.

        Raises:
            RobotError: there is none, and waiting is not wanted or would not help.
        """
        await self._workspace.ready()
        await self._workspace.fresh()
        finder, reason = first, ""
        patient = adaptation.watch and adaptation.patience_s > 0.0
        for _ in range(_TRIES):
            found = await finder.find(start)
            if isinstance(found, PlanRefusal):
                if finder is first and first is not onward and adaptation.watch:
                    # A planned way that is blocked meanwhile is a change like any other.
                    finder = onward
                    continue
                if patient and found.reason in TRANSIENT_REASONS and not await onward.is_permanently_blocked(start):
                    return found.message
                raise found.error()
            if self._workspace.lies(self._runner.name):
                # Planners let it touch what it lies on, and might lead through that.
                await self._carry.require_free(found.trajectory)
            if not adaptation.watch:
                return found
            # Asked of who watches, so that he is there when the arm moves.
            check = await finder.check(found, from_s=0.0, margin_m=finder.margin_m)
            if check.blocked_at_s is None:
                return found
            reason = describe_contacts(check.pairs)
        if patient:
            return reason
        raise RobotError(f"every way that was found is blocked by now: {reason}", hint="clear the way")

    async def _seen(self, find: Callable[[], Awaitable[PathSegment | PlanRefusal]]) -> PathSegment | PlanRefusal:
        """Find a way with cameras that see the cell."""
        self._workspace.require()
        try:
            await self._workspace.ready()
            await self._workspace.fresh()
            return await find()
        finally:
            self._workspace.release()

    def _finder(self, goal: PlanningGoal, options: PlanOptions) -> PathPlanner:
        settings = self._runner.port.settings
        at = (settings.tool_xyz_m, settings.tool_xyzw)
        tool = None if at == NO_FRAME else Pose(xyz=at[0], xyzw=at[1], frame="tool")
        return PathPlanner(self._runner.name, self._workspace, goal=goal, options=options, tool=tool)

    def _goal(self, target: MotionTarget, handle: ActiveGoal[Any]) -> PlanningGoal:
        if bool(target.joints) == (target.pose is not None):
            raise GoalRejected("a target is either `joints` or `pose`", where=handle.address, hint="give one of them")
        if target.pose is None:
            return JointGoal(joints_rad=(tuple(self._joints(target.joints, handle).tolist()),))
        world = self._runner.target(target.pose, handle)
        return PoseGoal(pose=world.to_pose(WORLD), match=target.match)

    def _joints(self, joints: tuple[float, ...], handle: ActiveGoal[Any]) -> Array:
        """Return a configuration as numbers; GoalRejected where it is none of this arm."""
        model = self._runner.model
        if not are_numbers(joints) or len(joints) != model.dof:
            raise GoalRejected(
                f"{len(joints)} joints were given", where=handle.address, hint=f"this arm has {model.dof}"
            )
        row = np.array(joints, dtype=np.float64)
        if not np.isfinite(row).all():
            raise GoalRejected(f"the joints {joints} are not finite", where=handle.address)
        return row

    def _planned(self, leg: PathSegment, options: PlanOptions, *, planning_s: float) -> PlannedMotion:
        return PlannedMotion(
            robot=self._runner.name,
            waypoints=leg.plan.waypoints_rad,
            speed=options.speed,
            duration_s=leg.trajectory.duration_s,
            tool_path=compute_tool_path(self._runner, sample_trajectory(leg.trajectory)),
            found_by=leg.plan.stats.found_by,
            planning_s=planning_s,
        )

    def _feedback(self, phase: MotionPhase, motion: AdaptiveMotion | None = None) -> FreeMotionFeedback:
        return FreeMotionFeedback(
            phase=phase,
            joints=self._runner.measured(),
            progress=motion.progress if motion is not None else 0.0,
            replans=motion.tally.replans if motion is not None else 0,
            waited_s=motion.waited_s if motion is not None else 0.0,
            reason=motion.reason if motion is not None else "",
        )


class _MotionDisplay:
    """Tells the goal and the preview what a motion does."""

    def __init__(
        self,
        tell: Callable[[MotionPhase, AdaptiveMotion | None], None],
        runner: MotionRunner,
        preview: PathPreviewPublisher,
    ) -> None:
        self._tell = tell
        self._runner = runner
        self._preview = preview
        self.motion: AdaptiveMotion | None = None

    def entered(self, phase: MotionPhase, reason: str) -> None:
        """Tell at once."""
        if phase == "moving":
            self._preview.mark("moving")
        elif phase != "planning":
            self._preview.mark("blocked", reason)
        self._tell(phase, self.motion)

    def follows(self, leg: PathSegment) -> None:
        """Show the way."""
        self._preview.show(leg.trajectory, state="moving")

    def result(self, duration_s: float) -> FreeMotionResult:
        """Return where the arm is and what the motion took."""
        motion = self.motion
        tally = motion.tally if motion is not None else AdaptiveMotionReport()
        return FreeMotionResult(
            joints=self._runner.measured(),
            duration_s=duration_s,
            stops=tally.stops,
            replans=tally.replans,
            reused=tally.reused,
            waited_s=motion.waited_s if motion is not None else 0.0,
            blocked=tally.blocked,
        )

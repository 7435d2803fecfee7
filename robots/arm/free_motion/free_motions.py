"""The collision-free motion skills of one arm: plan a path, execute a plan, or both, with replanning when blocked."""

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
from robots.arm.execution.motion_runner import NO_FRAME, MotionRunner
from robots.arm.execution.tool_frames import WORLD
from robots.arm.execution.validate_numbers import are_numbers
from robots.arm.free_motion.adaptive_motion import AdaptiveMotion
from robots.arm.free_motion.adaptive_motion_report import AdaptiveMotionReport
from robots.arm.free_motion.path_preview import PathPreviewPublisher, compute_tool_path, sample_trajectory
from robots.arm.scene_queries.attached_part_guard import AttachedPartGuard
from robots.arm.scene_queries.path_planner import (
    TRANSIENT_REASONS,
    PathPlanner,
    PathSegment,
    PlanningGoal,
    describe_contacts,
)
from robots.planning.request import JointGoal, PathGoal, PlanRefusal, PoseGoal
from robots.port import Array
from robots.supervise_goal import FEEDBACK_S
from robots.workspace.workspace import Workspace

# The scene may change during planning; the goal fails when this many planned paths in a row are already blocked.
_TRIES = 3
_AT_START_RAD = 0.01


class FreeMotions:
    """Serves PlanMotion, ExecutePlan and MoveFree, and publishes `<arm>/planned_path`."""

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
        planner = self._new_planner(self._goal(goal.target, handle), goal.options)
        handle.accept()
        started_s = runner.clock.now_s()
        planning = asyncio.ensure_future(self._plan_observed(lambda: planner.find(np.array(start))))
        try:
            while not (await asyncio.wait((planning,), timeout=FEEDBACK_S))[0]:
                handle.feedback(PlanFeedback(elapsed_s=runner.clock.now_s() - started_s))
        finally:
            planning.cancel()
        segment = planning.result()
        if isinstance(segment, PlanRefusal):
            raise SkillFailed(segment.message, where=handle.address, hint=segment.hint or None)
        self._preview.show(segment.trajectory, state="proposed")
        return self._planned(segment, goal.options, planning_s=runner.clock.now_s() - started_s)

    async def _move_free(self, goal: MoveFree, handle: ActiveGoal[FreeMotionFeedback]) -> FreeMotionResult:
        planner = self._new_planner(self._goal(goal.target, handle), goal.options)
        return await self._go(planner, planner, goal.adaptation, handle)

    async def _execute_plan(self, goal: ExecutePlan, handle: ActiveGoal[FreeMotionFeedback]) -> FreeMotionResult:
        plan = goal.plan
        if plan.robot != self._runner.name:
            raise GoalRejected(f"the plan is for {plan.robot}", where=handle.address, hint="plan for this arm")
        if len(plan.waypoints) < 1:
            raise GoalRejected("the plan has no waypoints", where=handle.address, hint="plan again")
        rows = tuple(tuple(self._joints(row, handle).tolist()) for row in plan.waypoints)
        gap = np.abs(np.array(rows[0]) - self._runner.port.sample().desired_rad)
        if gap.max() > _AT_START_RAD:
            joint = self._runner.model.arm_joints[int(np.argmax(gap))]
            raise GoalRejected(
                f"the plan does not start at the arm's current joints: {joint} differs by {gap.max():.3f} rad,"
                f" at most {_AT_START_RAD:g} rad are allowed",
                where=handle.address,
                hint="plan again from the current joints",
            )
        options = msgspec.structs.replace(goal.options, speed=plan.speed)
        onward = self._new_planner(JointGoal(joints_rad=(rows[-1],)), options)
        first = self._new_planner(PathGoal(waypoints_rad=rows), options)
        return await self._go(first, onward, goal.adaptation, handle)

    async def _go(
        self, first: PathPlanner, onward: PathPlanner, adaptation: Adaptation, handle: ActiveGoal[FreeMotionFeedback]
    ) -> FreeMotionResult:
        """Plan the first path, or reject the goal; follow it, and replan with `onward` where it is blocked."""
        runner, workspace = self._runner, self._workspace
        handle.feedback(self._feedback("planning"))
        workspace.require()
        try:
            segment = await runner.planned(handle, lambda start: self._first_segment(first, onward, start, adaptation))
            display = _MotionDisplay(
                lambda phase, motion: handle.feedback(self._feedback(phase, motion)), runner, self._preview
            )

            def start() -> AdaptiveMotion:
                motion = AdaptiveMotion(
                    segment, runner=runner, planner=onward, workspace=workspace, adaptation=adaptation, listener=display
                )
                display.motion = motion
                return motion

            ended = await runner.carry_out(
                start,
                handle,
                lambda motion: handle.feedback(self._feedback(motion.phase, motion)),
                failed_result=display.result,
            )
            return display.result(ended.duration_s)
        finally:
            workspace.release()
            self._preview.clear()

    async def _first_segment(
        self, first: PathPlanner, onward: PathPlanner, start: Array, adaptation: Adaptation
    ) -> PathSegment | str:
        """Return a path that is free now, or the reason to wait for one.

        Raises:
            RobotError: there is no path, and waiting is not requested or would not help.
        """
        await self._workspace.ready()
        await self._workspace.fresh()
        planner, reason = first, ""
        patient = adaptation.watch and adaptation.patience_s > 0.0
        for _ in range(_TRIES):
            segment = await planner.find(start)
            if not isinstance(segment, PlanRefusal) and (unhealthy := self._workspace.unhealthy_reason):
                raise RobotError(unhealthy, hint="put the camera right; its status is on `<camera>/status`")
            if isinstance(segment, PlanRefusal):
                if planner is first and first is not onward and adaptation.watch:
                    # A given plan that is blocked by now is handled like any other scene change.
                    planner = onward
                    continue
                if patient and segment.reason in TRANSIENT_REASONS and not await onward.is_permanently_blocked(start):
                    return segment.message
                raise segment.error()
            if self._workspace.lies(self._runner.name):
                # Planners allow contact with the object it lies on, so a path might lead through that object.
                await self._carry.require_free(segment.trajectory)
            if not adaptation.watch:
                return segment
            # Asks the monitoring process, so that it is running when the arm moves.
            check = await planner.check(segment, from_s=0.0, margin_m=planner.margin_m)
            if check.blocked_at_s is None:
                return segment
            reason = describe_contacts(check.pairs)
        if patient:
            return reason
        raise RobotError(f"every planned path is already blocked: {reason}", hint="remove the obstacle")

    async def _plan_observed(
        self, find: Callable[[], Awaitable[PathSegment | PlanRefusal]]
    ) -> PathSegment | PlanRefusal:
        """Plan a path with the cameras in operation."""
        self._workspace.require()
        try:
            await self._workspace.ready()
            await self._workspace.fresh()
            return await find()
        finally:
            self._workspace.release()

    def _new_planner(self, goal: PlanningGoal, options: PlanOptions) -> PathPlanner:
        settings = self._runner.port.settings
        at = (settings.tool_xyz_m, settings.tool_xyzw)
        tool = None if at == NO_FRAME else Pose(xyz=at[0], xyzw=at[1], frame="tool")
        return PathPlanner(self._runner.name, self._workspace, goal=goal, options=options, tool=tool)

    def _goal(self, target: MotionTarget, handle: ActiveGoal[Any]) -> PlanningGoal:
        if bool(target.joints) == (target.pose is not None):
            raise GoalRejected("a target has either `joints` or `pose`", where=handle.address, hint="give one of them")
        if target.pose is None:
            return JointGoal(joints_rad=(tuple(self._joints(target.joints, handle).tolist()),))
        world = self._runner.target(target.pose, handle)
        return PoseGoal(pose=world.to_pose(WORLD), match=target.match)

    def _joints(self, joints: tuple[float, ...], handle: ActiveGoal[Any]) -> Array:
        """Return a configuration as an array; raises GoalRejected if it does not fit this arm."""
        model = self._runner.model
        if not are_numbers(joints) or len(joints) != model.dof:
            raise GoalRejected(f"got {len(joints)} joints", where=handle.address, hint=f"this arm has {model.dof}")
        row = np.array(joints, dtype=np.float64)
        if not np.isfinite(row).all():
            raise GoalRejected(f"the joints {joints} are not finite", where=handle.address)
        return row

    def _planned(self, segment: PathSegment, options: PlanOptions, *, planning_s: float) -> PlannedMotion:
        return PlannedMotion(
            robot=self._runner.name,
            waypoints=segment.plan.waypoints_rad,
            speed=options.speed,
            duration_s=segment.trajectory.duration_s,
            tool_path=compute_tool_path(self._runner, sample_trajectory(segment.trajectory)),
            found_by=segment.plan.stats.found_by,
            planning_s=planning_s,
        )

    def _feedback(self, phase: MotionPhase, motion: AdaptiveMotion | None = None) -> FreeMotionFeedback:
        return FreeMotionFeedback(
            phase=phase,
            joints=self._runner.measured(),
            progress=motion.progress if motion is not None else 0.0,
            replans=motion.statistics.replans if motion is not None else 0,
            waited_s=motion.waited_s if motion is not None else 0.0,
            reason=motion.reason if motion is not None else "",
        )


class _MotionDisplay:
    """Reports the phases and paths of a motion to the goal and the preview."""

    def __init__(
        self,
        publish: Callable[[MotionPhase, AdaptiveMotion | None], None],
        runner: MotionRunner,
        preview: PathPreviewPublisher,
    ) -> None:
        self._publish = publish
        self._runner = runner
        self._preview = preview
        self.motion: AdaptiveMotion | None = None

    def entered(self, phase: MotionPhase, reason: str) -> None:
        """Publish the phase immediately."""
        if phase == "moving":
            self._preview.mark("moving")
        elif phase != "planning":
            self._preview.mark("blocked", reason)
        self._publish(phase, self.motion)

    def follows(self, segment: PathSegment) -> None:
        """Show the path."""
        self._preview.show(segment.trajectory, state="moving")

    def result(self, duration_s: float) -> FreeMotionResult:
        """Return the arm's joints and the statistics of the motion."""
        motion = self.motion
        statistics = motion.statistics if motion is not None else AdaptiveMotionReport()
        return FreeMotionResult(
            joints=self._runner.measured(),
            duration_s=duration_s,
            stops=statistics.stops,
            replans=statistics.replans,
            reused=statistics.reused,
            waited_s=motion.waited_s if motion is not None else 0.0,
            blocked=statistics.blocked,
            deviation_rad=self._runner.deviation_rad(),
        )

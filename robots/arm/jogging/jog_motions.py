"""Jogging of joints or tool: at a velocity for a time, as commanded on `<arm>/jog`, or step by step."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncGenerator, Awaitable, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any

import msgspec
import numpy as np

from engine.bus import ActiveGoal, SkillBus, Topic
from engine.errors import BusError, FlexcellError, GoalRejected, SkillFailed
from engine.messages.tool_hold import ToolHold
from engine.skills.axes import Axes
from engine.skills.collision_options import CollisionOptions
from engine.skills.jogging import (
    JogBlock,
    JogCollisionOptions,
    JogCommand,
    JogJoints,
    JogReady,
    JogTool,
    JointJogFeedback,
    PrepareJog,
    StepJoints,
    StepTool,
    ToolJogFeedback,
)
from engine.skills.motion import CartMotionFeedback, CartMotionResult, JointMotionFeedback, JointMotionResult
from robots.arm.execution.given_path import monitored_motion
from robots.arm.execution.motion_runner import MotionCompletion, MotionRunner
from robots.arm.execution.trajectory_goal import Monitored, follow_joints, follow_tool, unmonitored
from robots.arm.jogging.directions_out import DirectionsOut
from robots.arm.jogging.jog_guard import JogGuard, ToJoints
from robots.arm.jogging.jog_run import JogRun
from robots.arm.jogging.press_queue import Row
from robots.arm.scene_queries.attached_part_guard import AttachedPartGuard
from robots.arm.scene_queries.path_guard import AdmittedPath, PathRules
from robots.arm.scene_queries.scene_check import SceneCheck
from robots.control.generators.damped_inverse import joint_velocity, twist_rows
from robots.model.transform import RigidTransform, product, quaternion_of
from robots.motion.min_jerk import PEAK_ACCELERATION, PEAK_SPEED
from robots.port import Array, JointTrajectory, StreamKind
from robots.workspace.workspace import Workspace

_TWIST = 6
# Steps in which ways out of a block are tried: along and about the axes of the tool, and of a joint.
_TRIED_M, _TRIED_RAD, _TRIED_JOINT_RAD = 0.005, 0.03, 0.02
_BLOCK_SHOWN_S = 10.0
# Limits of a tool step: rotation speed, linear and angular acceleration.
_STEP_TURN_RAD_S, _STEP_M_S2, _STEP_RAD_S2 = 0.5, 0.5, 2.0
_SHORTEST_STEP_S = 0.1
_MOST_TURN_RAD = 3.1
_UNKNOWN_PART = "?"


class JogMotions:
    """Serves JogJoints, JogTool, StepJoints, StepTool and PrepareJog; takes `<arm>/jog`, publishes `<arm>/jog_block`.

    Args:
        runner: The arm's motion runner.
        workspace: The workspace shared with other arms; without one jogs are not checked for collisions.
        tool: Bus namespace of the tool on the arm, which publishes what it holds on `<tool>/state`; empty without one.
    """

    def __init__(self, runner: MotionRunner, workspace: Workspace | None = None, *, tool: str = "") -> None:
        self._runner = runner
        self._tool = tool
        self._workspace = workspace
        self._run: JogRun | None = None
        self._bus: SkillBus | None = None
        self._blocks: Topic[JogBlock] | None = None
        self._hiding: asyncio.TimerHandle | None = None
        self._preparing = asyncio.Lock()
        self._preparations = 0
        self._latest_prepared = 0

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills under the arm's name."""
        name = self._runner.name
        self._bus = bus
        bus.advertise_action(JogJoints, self._jog_joints, namespace=name, exclusive=name)
        bus.advertise_action(JogTool, self._jog_tool, namespace=name, exclusive=name)
        bus.advertise_action(StepJoints, self._step_joints, namespace=name, exclusive=name)
        bus.advertise_action(StepTool, self._step_tool, namespace=name, exclusive=name)
        bus.advertise_service(PrepareJog, self._prepare, namespace=name)
        bus.topic(f"{name}/jog", JogCommand).subscribe_commands(self._take)
        self._blocks = bus.topic(f"{name}/jog_block", JogBlock)

    def _take(self, command: JogCommand) -> None:
        if self._run is not None:
            self._run.take(command)

    async def _prepare(self, request: PrepareJog) -> JogReady:
        del request
        clock = self._runner.clock
        start_s, before = clock.now_s(), self._preparations
        async with self._preparing:
            # One that began after this request serves it too.
            if self._latest_prepared <= before:
                self._preparations += 1
                await self._open_once()
                self._latest_prepared = self._preparations
        return JogReady(waited_s=clock.now_s() - start_s)

    async def _open_once(self) -> None:
        guard = self._guard(JogCollisionOptions(), lambda velocity, _: velocity, lambda joints: joints[None] * 0.0)
        if guard is None:
            return
        try:
            await guard.open()
        except FlexcellError as error:
            raise SkillFailed(error.message, where=self._runner.name, hint=error.hint) from error
        await guard.close()

    async def _jog_joints(self, goal: JogJoints, handle: ActiveGoal[JointJogFeedback]) -> JointMotionResult:
        runner = self._runner
        width = runner.model.dof
        guard = self._guard(goal.scene, lambda commanded, _: commanded, lambda _: np.eye(width) * _TRIED_JOINT_RAD)
        run = JogRun(
            goal,
            goal.velocity_rad_s,
            handle,
            clock=runner.clock,
            width=width,
            to_command=lambda commanded, _: commanded,
            guard=guard,
        )

        def publish_feedback() -> None:
            held_by = guard.held_by if guard else ""
            handle.feedback(JointJogFeedback(joints=runner.measured(), held_by=held_by, dropped=run.dropped))

        ended = await self._jog("joint_velocity", run, guard, handle, publish_feedback)
        return JointMotionResult(joints=runner.measured(), duration_s=ended.duration_s)

    async def _jog_tool(self, goal: JogTool, handle: ActiveGoal[ToolJogFeedback]) -> CartMotionResult:
        runner = self._runner

        def to_command(velocity: Row, frame: Axes | None) -> Row:
            axes = runner.frames.axes(frame or goal.frame, tool=runner.measured_tool())
            return tuple(np.concatenate((axes @ velocity[:3], axes @ velocity[3:])).tolist())

        def steps(joints: Array) -> Array:
            twists = np.diag([_TRIED_M] * 3 + [_TRIED_RAD] * 3)
            return np.array(
                [self._joint_velocity(np.array(to_command(tuple(twist), run.frame)), joints) for twist in twists]
            )

        guard = self._guard(goal.scene, self._joint_velocity, steps)
        run = JogRun(goal, goal.velocity, handle, clock=runner.clock, width=_TWIST, to_command=to_command, guard=guard)

        def publish_feedback() -> None:
            held_by = guard.held_by if guard else ""
            handle.feedback(ToolJogFeedback(pose=runner.measured_pose(), held_by=held_by, dropped=run.dropped))

        ended = await self._jog("tool_twist", run, guard, handle, publish_feedback)
        return CartMotionResult(pose=runner.measured_pose(), duration_s=ended.duration_s)

    def _guard(
        self, rule: JogCollisionOptions, to_joints: ToJoints, steps: Callable[[Array], Array]
    ) -> JogGuard | None:
        if self._workspace is None or not rule.minded:
            return None
        return JogGuard(
            self._runner,
            self._workspace,
            rule=self._with_held_part(rule, self._workspace),
            to_joints=to_joints,
            directions_out=DirectionsOut(self._runner, steps),
            publish=self._publish_block,
        )

    def _publish_block(self, block: JogBlock) -> None:
        if self._hiding is not None:
            self._hiding.cancel()
            self._hiding = None
        if self._blocks is not None and block != (self._blocks.latest or JogBlock(robot=block.robot)):
            self._blocks.publish(block)

    def _forget_block(self) -> None:
        """Let go of a block some time after its jog, so that it can be read."""
        block = self._blocks.latest if self._blocks is not None else None
        if block is not None and block.first:
            self._hiding = asyncio.get_running_loop().call_later(
                _BLOCK_SHOWN_S, self._publish_block, JogBlock(robot=self._runner.name)
            )

    def _with_held_part(self, rule: JogCollisionOptions, workspace: Workspace) -> JogCollisionOptions:
        """Return the options for an arm whose tool may hold a part: its own part is no obstacle for it.

        A part that is not attached in the scene is an obstacle there, which follows the tool and would block it.
        """
        part = self._held_part()
        if not part or workspace.holds(self._runner.name):
            return rule
        return msgspec.structs.replace(rule, may_touch=(*rule.may_touch, part))

    def _held_part(self) -> str:
        """Return the name of the part that the tool holds; empty if there is none, or its name is not known."""
        if self._bus is None or not self._tool:
            return ""
        try:
            state = self._bus.find_topic(f"{self._tool}/state").latest
        except BusError:
            # A tool that publishes nothing tells nothing.
            return ""
        return state.part if isinstance(state, ToolHold) and state.held and state.part != _UNKNOWN_PART else ""

    def _joint_velocity(self, twist: Array, joints: Array) -> Array:
        _, jacobian = self._runner.kinematics.tool_pose_and_jacobian(joints)
        rows = twist_rows(twist, self._runner.model.dof)
        return joint_velocity(jacobian[rows], twist[rows])

    async def _jog(
        self,
        kind: StreamKind,
        run: JogRun,
        guard: JogGuard | None,
        handle: ActiveGoal[Any],
        publish_feedback: Callable[[], None],
    ) -> MotionCompletion:
        runner = self._runner
        runner.require_ready(handle)
        async with AsyncExitStack() as stack:

            def look(_stream: object) -> None:
                run.look()
                publish_feedback()

            # Whoever learns that the goal is accepted may command at once.
            self._run = run
            try:
                if guard is not None:
                    await runner.planned(handle, lambda _: guard.open())
                    stack.push_async_callback(guard.close)
                else:
                    runner.accept(handle)
                return await runner.carry_out(
                    lambda: run.start(runner.port.stream(kind, watchdog_s=run.watchdog_s)), handle, look, mode="jogging"
                )
            finally:
                self._run = None
                run.close()
                self._forget_block()

    async def _free(self, planning: Awaitable[JointTrajectory], rule: JogCollisionOptions) -> JointTrajectory:
        """Return a planned collision-free step; raises RobotError if there is none."""
        trajectory = await planning
        if self._workspace is not None and rule.minded:
            rule = self._with_held_part(rule, self._workspace)
            await SceneCheck(self._runner.name, self._workspace, rule=rule).require_free(trajectory)
            # The scene allows contact of a part with the object it was picked from, at any depth.
            await AttachedPartGuard(self._runner.name, self._workspace).require_free(trajectory)
        return trajectory

    @asynccontextmanager
    async def _monitored(self, trajectory: JointTrajectory, rule: JogCollisionOptions) -> AsyncGenerator[Monitored]:
        """Monitor a step meanwhile, as motions along given paths are."""
        guard = self._runner.path_guard
        if guard is None or self._workspace is None or not rule.minded:
            yield unmonitored
            return
        may_touch = self._with_held_part(rule, self._workspace).may_touch
        path = AdmittedPath(trajectory=trajectory, rules=PathRules(tool_contact="never", may_touch=may_touch))
        async with guard.observed():
            yield lambda motion: monitored_motion(motion, path, self._runner, guard=guard, options=CollisionOptions())

    async def _step_joints(self, goal: StepJoints, handle: ActiveGoal[JointMotionFeedback]) -> JointMotionResult:
        runner = self._runner
        if len(goal.step_rad) != runner.model.dof:
            raise GoalRejected(
                f"the step has {len(goal.step_rad)} joints",
                where=handle.address,
                hint=f"this arm has {runner.model.dof}",
            )
        trajectory = await runner.planned(
            handle,
            lambda start: self._free(
                runner.planner.to_joints(start, start + np.array(goal.step_rad), speed=goal.speed), goal.scene
            ),
        )
        async with self._monitored(trajectory, goal.scene) as monitored:
            return await follow_joints(runner, trajectory, handle, mode="jogging", monitored=monitored)

    async def _step_tool(self, goal: StepTool, handle: ActiveGoal[CartMotionFeedback]) -> CartMotionResult:
        runner = self._runner
        runner.require_ready(handle)
        start = runner.kinematics.tool_pose(runner.port.sample().desired_rad)
        end = self._step_goal(goal, start, handle)
        trajectory = await runner.planned(
            handle,
            lambda joints: self._free(
                runner.planner.along_line(joints, end, duration_s=_step_time_s(goal)), goal.scene
            ),
        )
        async with self._monitored(trajectory, goal.scene) as monitored:
            return await follow_tool(runner, trajectory, handle, mode="jogging", monitored=monitored)

    def _step_goal(
        self, goal: StepTool, tool: RigidTransform, handle: ActiveGoal[CartMotionFeedback]
    ) -> RigidTransform:
        step = np.array((*goal.step_m, *goal.turn_rad))
        if not np.isfinite(step).all() or not step.any():
            raise GoalRejected(
                "the step is zero or not finite", where=handle.address, hint="give `step_m`, `turn_rad` or both"
            )
        turn = math.hypot(*goal.turn_rad)
        if turn > _MOST_TURN_RAD:
            # Half a turn or more would be executed in the opposite, shorter direction.
            raise GoalRejected(
                f"a step cannot rotate the tool by {turn:.3g} rad",
                where=handle.address,
                hint="rotate by less than half a turn",
            )
        axes = self._runner.frames.axes(goal.frame, tool=tool)
        return RigidTransform(xyz=tool.xyz + axes @ step[:3], xyzw=product(quaternion_of(axes @ step[3:]), tool.xyzw))


def _step_time_s(goal: StepTool) -> float:
    distance, turn = math.hypot(*goal.step_m), math.hypot(*goal.turn_rad)
    return max(
        _SHORTEST_STEP_S,
        PEAK_SPEED * distance / goal.speed_m_s,
        PEAK_SPEED * turn / _STEP_TURN_RAD_S,
        float(np.sqrt(PEAK_ACCELERATION * distance / _STEP_M_S2)),
        float(np.sqrt(PEAK_ACCELERATION * turn / _STEP_RAD_S2)),
    )

"""Executes the motions of one arm, one at a time: accepts or rejects a goal, supervises its motion, stops the arm."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from engine.bus import ActiveGoal
from engine.cause_chain import cause_of, describe_cause
from engine.clock import Clock
from engine.errors import CONNECT_AGAIN, GoalRejected, PathBlocked, RobotError, SkillFailed
from engine.messages import Pose, Quaternion, Vector3
from engine.robot import DeviceStatus
from engine.skills.arm_control import ArmMode
from robots.arm.execution.arm_planner import ArmPlanner
from robots.arm.execution.tool_frames import WORLD, ToolFrames
from robots.arm.execution.warm_up import WarmUp
from robots.arm.scene_queries.path_guard import PathGuard
from robots.model.arm_base import ArmBase
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.port import ArmPort, Array, Motion, MotionEnd, MotionReport, MotionStream, Tolerance
from robots.port.set_point import to_set_point
from robots.supervise_goal import supervise_goal

T = TypeVar("T")
M = TypeVar("M", bound=Motion)

NO_FRAME: tuple[Vector3, Quaternion] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
"""A tool centre point at the tool link."""
_REST_RAD_S = 0.02
# Longest time a moving arm may take to come to rest, and the polling period.
_BRAKING_S, _POLL_S = 2.0, 0.01
_LOADING = "waiting until inverse kinematics is loaded"

_log = logging.getLogger("flexcell.arm")


@dataclass(frozen=True, kw_only=True)
class MotionCompletion:
    """Report and duration of a motion that ended without a failure."""

    report: MotionReport
    duration_s: float


class MotionRunner:
    """Shared state of the skill groups of one arm; created by `ArmServer`.

    Attributes:
        name: Bus namespace and resource of the arm.
        status: READY between entering and leaving the robot.
        reserved_for: The mode that blocks other goals now; empty without one.
        activity: The skill in execution, or what a goal waits for; empty without either.
        error: Why the last motion failed; empty if it did not.
        lost_reason: Why the device is not reachable; empty while it is.
        changed: Called after a change of any of these.
        path_guard: Checks given paths in the planning scene; None without one.
    """

    def __init__(
        self,
        *,
        name: str,
        model: RobotModel,
        base: RigidTransform | ArmBase,
        port: ArmPort,
        clock: Clock,
        tolerance: Tolerance,
        path_guard: PathGuard | None = None,
        frames: Mapping[str, Pose] | None = None,
    ) -> None:
        self.name = name
        self.model = model
        self.port = port
        self.clock = clock
        self.tolerance = tolerance
        self.path_guard = path_guard
        self._at_link = self._kinematics = ArmKinematics(model, base=base)
        self._tool: tuple[Vector3, Quaternion] = NO_FRAME
        self._planner = self._new_planner()
        self.loading = WarmUp(name, self._planner.prepare)
        self.frames = ToolFrames(arm=name, base_link=model.base_link, base=self._at_link.stand, named=frames)
        self.status = DeviceStatus.DISCONNECTED
        self.reserved_for = ""
        self.activity = ""
        self.error = ""
        self.lost_reason = ""
        self.changed: Callable[[], None] = _no_operation
        self._mode: ArmMode = "moving"
        self._motion: Motion | None = None
        port.when_reflex(self._on_reflex)
        self._occupied: asyncio.Task[None] | None = None
        self._planning = 0
        self._stops = 0

    @property
    def moving(self) -> bool:
        """True while a goal is executed, or a stream commands the arm."""
        return self._motion is not None

    @property
    def busy(self) -> bool:
        """True also while a motion is planned."""
        return self.moving or self._planning > 0

    @property
    def stops(self) -> int:
        """How often the arm has been stopped, or lost."""
        return self._stops

    @property
    def mode(self) -> ArmMode:
        """The current mode of the arm."""
        if self.status is DeviceStatus.DISCONNECTED:
            return "disconnected"
        if self._motion is not None:
            return self._mode
        if self.port.sample().reflex:
            return "reflex"
        return "fault" if self.status is DeviceStatus.FAULT else "idle"

    @property
    def kinematics(self) -> ArmKinematics:
        """Kinematics of the arm with the current tool center point."""
        self._update_tool()
        return self._kinematics

    @property
    def planner(self) -> ArmPlanner:
        """Planner for the current tool center point."""
        self._update_tool()
        return self._planner

    def measured(self) -> tuple[float, ...]:
        """Return the measured joints."""
        return tuple(self.port.sample().position_rad.tolist())

    def deviation_rad(self) -> float:
        """Return how far the measured joint that is farthest from its set point is."""
        return to_set_point(self.port.sample(), self.model.arm_joints).deviation_rad

    def set_point(self) -> tuple[float, ...]:
        """Return the currently commanded joints, where the next motion starts."""
        return tuple(self.port.sample().desired_rad.tolist())

    def measured_pose(self) -> Pose:
        """Return the measured pose of the tool center point in the world."""
        return self.measured_tool().to_pose(WORLD)

    def measured_tool(self) -> RigidTransform:
        """Return the measured tool center point in the world as a transform."""
        return self.kinematics.tool_pose(self.port.sample().position_rad)

    def target(self, pose: Pose, handle: ActiveGoal[Any]) -> RigidTransform:
        """Return the pose of a goal in the world; raises GoalRejected for an unknown frame."""
        try:
            return self.frames.to_world(pose)
        except RobotError as error:
            raise GoalRejected(error.message, where=handle.address, hint=error.hint) from None

    async def planned(self, handle: ActiveGoal[Any], plan: Callable[[Array], Awaitable[T]]) -> T:
        """Plan from the set point and accept the goal, or reject it with the reason."""
        self.require_ready(handle)
        stops = self._stops
        self._planning += 1
        try:
            planned = await plan(self.port.sample().desired_rad)
        except PathBlocked as error:
            raise GoalRejected("the path is not free", where=handle.address) from error
        except RobotError as error:
            # The rejection carries the full message; chaining would only repeat it.
            raise GoalRejected(error.message, where=handle.address, hint=error.hint) from None
        except (ArithmeticError, ValueError) as error:
            # Extreme numbers, such as gains of 1e300, overflow during planning.
            raise GoalRejected(
                f"no motion can be computed from these numbers: {error}",
                where=handle.address,
                hint="check the goal for values that are too large or too small",
            ) from error
        finally:
            self._planning -= 1
        if self._stops != stops:
            raise GoalRejected("the arm was stopped or lost during planning", where=handle.address)
        self.accept(handle)
        return planned

    async def loaded(self) -> None:
        """Return when inverse kinematics answers without a loading delay; the status shows the wait.

        Raises:
            RobotError: it is not loaded in time.
        """
        if not self.loading.active:
            return
        _log.info("%s: %s", self.name, _LOADING)
        if not self.moving:
            self.activity = _LOADING
            self.changed()
        try:
            await self.loading.finished()
        finally:
            if self.activity == _LOADING:
                self.activity = ""
                self.changed()

    def accept(self, handle: ActiveGoal[Any]) -> None:
        """Accept a goal that needs no further plan, or reject it with the reason."""
        self.require_ready(handle)
        handle.accept()

    def require_ready(self, handle: ActiveGoal[Any]) -> None:
        """Raise GoalRejected while the arm accepts no goals."""
        reason, hint = self.obstacle()
        if reason:
            raise GoalRejected(reason, where=handle.address, hint=hint)

    def obstacle(self) -> tuple[str, str]:
        """Return why the arm accepts no goals now, and a hint; both empty if it accepts them."""
        if self.lost_reason:
            return self.lost_reason, CONNECT_AGAIN
        if self.status is not DeviceStatus.READY:
            return f"the arm is {self.status.value}", "connect it first"
        if self.reserved_for:
            return f"the arm is in {self.reserved_for}", "switch that off first"
        if self.port.sample().reflex:
            why = self.port.reflex_reason
            return (
                "the arm has stopped by itself" + (f": {why}" if why else ""),
                "remove the obstacle, then call recover_from_error",
            )
        return "", ""

    async def carry_out(
        self,
        start: Callable[[], M],
        handle: ActiveGoal[Any],
        publish_feedback: Callable[[M], None],
        *,
        words: str = "the arm",
        mode: ArmMode = "moving",
        failed_result: Callable[[float], object] | None = None,
    ) -> MotionCompletion:
        """Start a motion and return its completion; also returns for a canceled goal, with the arm at rest.

        `failed_result` creates the result of a failed motion, with where it left the arm, from its duration in seconds.

        Raises:
            SkillFailed: the motion could not be started, failed, or was stopped by another command.
        """
        started_s = self.clock.now_s()
        try:
            motion = start()
        except RobotError as error:
            raise SkillFailed("the motion was not started", where=handle.address) from error
        self.error = ""
        self._begin(motion, mode, handle.address.rpartition("/")[2])
        try:
            await supervise_goal(
                motion, handle, publish=lambda: publish_feedback(motion), device=self.name, words=words
            )
        except (SkillFailed, RobotError) as error:
            self.error = describe_cause(cause_of(error))
            if failed_result is not None and isinstance(error, SkillFailed):
                error.result = failed_result(self.clock.now_s() - started_s)
            raise
        finally:
            self._end()
        return MotionCompletion(report=await motion.report(), duration_s=self.clock.now_s() - started_s)

    def occupy(self, stream: MotionStream, *, mode: ArmMode, activity: str, reserved_for: str) -> None:
        """Accept no goals until `stream`, which no goal started, has ended."""
        self.reserved_for = reserved_for
        self._begin(stream, mode, activity)
        self._occupied = asyncio.create_task(self._until_free(stream), name=f"{activity} of {self.name}")

    async def freed(self) -> None:
        """Return when no stream occupies the arm."""
        if self._occupied is not None:
            await asyncio.wait((self._occupied,))

    def lose(self, reason: str) -> None:
        """Accept no goals until `find`: the device is not reachable."""
        # What was planned before must not move the arm once it is found.
        self._stops += 1
        self.status, self.lost_reason, self.error = DeviceStatus.FAULT, reason, reason
        self.changed()

    def find(self) -> None:
        """Accept goals again: the device is reachable again, at rest."""
        self.status, self.lost_reason, self.error = DeviceStatus.READY, "", ""
        self.changed()

    async def stop(self) -> None:
        """Cancel the current motion and return at its end."""
        self._stops += 1
        if self._motion is not None:
            self._motion.cancel()
            await self._motion.report()
        await self.freed()

    def brake(self) -> None:
        """Cancel the current motion; `stop` waits for its end."""
        self._stops += 1
        if self._motion is not None:
            self._motion.cancel()

    async def confirm_rest(self) -> None:
        """Return when the arm is measured at rest.

        Raises:
            RobotError: the arm still moves, and the status is then FAULT; or it is not reachable.
        """
        if self.lost_reason:
            raise RobotError(self.lost_reason, where=self.name, hint=CONNECT_AGAIN)
        patience_s = self.clock.now_s() + _BRAKING_S
        while True:
            speed = np.abs(self.port.sample().velocity_rad_s)
            fastest = int(np.argmax(speed))
            if speed[fastest] <= _REST_RAD_S:
                return
            if self.clock.now_s() >= patience_s:
                self.status = DeviceStatus.FAULT
                self.changed()
                raise RobotError(
                    f"{self.model.arm_joints[fastest]} still moves at {speed[fastest]:.3f} rad/s after the stop",
                    where=self.name,
                    hint="use the emergency stop",
                )
            await self.clock.sleep(_POLL_S)

    def _on_reflex(self, reason: str) -> None:
        """Report immediately; an active motion fails and reports the reason itself."""
        if self._motion is None:
            self.error = f"the arm has stopped by itself: {reason}"
        self.changed()

    def _begin(self, motion: Motion, mode: ArmMode, activity: str) -> None:
        self._motion, self._mode, self.activity = motion, mode, activity
        self.changed()

    def _end(self) -> None:
        self._motion, self.activity = None, ""
        self.changed()

    async def _until_free(self, stream: MotionStream) -> None:
        report = await stream.report()
        self.error = report.reason if report.end is MotionEnd.FAILED else ""
        self.reserved_for = ""
        self._occupied = None
        self._end()

    def _update_tool(self) -> None:
        """Update kinematics and planner to the tool center point of the settings, which a restore may change."""
        settings = self.port.settings
        tool = (settings.tool_xyz_m, settings.tool_xyzw)
        if tool == self._tool:
            return
        self._tool = tool
        self._kinematics = self._at_link if tool == NO_FRAME else self._at_link.with_tool(RigidTransform.of(*tool))
        self._planner = self._new_planner()

    def _new_planner(self) -> ArmPlanner:
        return ArmPlanner(self._kinematics.twin(), clock=self.clock, loaded=self.loaded)


def _no_operation() -> None:
    """Do nothing."""

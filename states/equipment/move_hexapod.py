"""equipment.MoveHexapod: an arm that holds the platform of a hexapod moves it to one of its poses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import Cause, SkillFailed
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, interpolate_poses, invert_pose
from engine.skills import device_moves
from engine.skills.collision_options import CollisionOptions
from engine.skills.hexapods import HexapodMove, PlanHexapodMove, ReadHexapod
from engine.skills.motion import CartLinTask, ForwardKinematics
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.equipment.device_parameter_types import DeviceName
from states.equipment.hexapod_error import AngleTolerance, HexapodError, HexapodPoseName, PositionTolerance
from states.equipment.switch_brakes import switch_brakes
from states.motion.line_duration import line_duration_s
from states.motion.motion_target import RobotName

_CORRECTION_S = 0.5
# Legs hold back a platform that went too far, by twice their friction: each correction ends before the goal.
_GAIN = 0.9


class MoveHexapod(State, frozen=True, kw_only=True):
    """Release the brakes, move the platform that the arm holds to a pose on a line, and lock the brakes.

    `beyond_limits` before anything moves, with the leg and the amount. The arm corrects what is measured, and the pose
    is measured once more with locked brakes: `reached` within the tolerances, else `off`. Measured `by` the arm is its
    tool centre point, which does not see that the platform slips in its grip; by the cell, where that shows the
    platform. A cancel leaves the brakes as they are; where the arm does not reach the pose, they are locked.
    """

    state_name: ClassVar[str] = "equipment.MoveHexapod"
    skills: ClassVar[Skills] = (device_moves.MoveDevice, CartLinTask)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "off", "beyond_limits", "brakes_failed", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)
    outputs: ClassVar[Mapping[str, Any]] = {"error_m": float, "error_rad": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("beyond_limits", "brakes_failed", "failed"), ("error_m", "error_rad")
    )

    robot: RobotName
    device: DeviceName
    pose: HexapodPoseName
    speed_m_s: Annotated[
        float, Meta(gt=0, le=0.2, description="Maximum speed of the tool", extra_json_schema={"unit": "m/s"})
    ] = 0.03
    by: Annotated[Literal["arm", "cell"], Meta(description="What measures where the platform is")] = "arm"
    settle_s: Annotated[
        float, Meta(ge=0, le=10, description="Time at rest before it is measured", extra_json_schema={"unit": "s"})
    ] = 0.4
    corrections: Annotated[int, Meta(ge=0, le=50, description="Maximum number of corrections")] = 10
    tolerance_m: PositionTolerance = 0.0005
    tolerance_rad: AngleTolerance = 0.0035

    def resources(self) -> tuple[str, ...]:
        """Return the arm and the device."""
        return (self.robot, self.device)

    async def run(self, ctx: Context) -> Outcome:
        """Plan, release, move, correct, lock, measure."""
        try:
            tool = await ctx.call(ForwardKinematics(), to=self.robot)
            move = await ctx.call(PlanHexapodMove(pose=self.pose, tool=tool), to=self.device)
            if move.refused:
                because = Cause(message=move.refused, where=f"{self.device}/{PlanHexapodMove.skill_name()}")
                return self._not("beyond_limits", because, ctx)
            held = compose_poses(invert_pose(move.start), tool)
            fault = await self._switch(ctx, move.released)
            if fault is not None:
                return self._not("brakes_failed", fault, ctx)
            stopped = await self._approach(ctx, move, tool, held)
            fault = await self._switch(ctx, move.locked)
            if fault is not None or stopped is not None:
                return self._not("brakes_failed" if fault is not None else "failed", fault or stopped, ctx)
            measured = await self._measured(ctx, held)
        except SkillFailed as error:
            return self._not("failed", cause_of(error), ctx)
        error = HexapodError.between(measured, move.platform)
        if error.within(self.tolerance_m, self.tolerance_rad):
            return Outcome("reached", error.outputs)
        because = Cause(
            message=f"with locked brakes it is {error.words} away, measured by the {self.by}",
            where=f"{self.device}/{PlanHexapodMove.skill_name()}",
            compared=error.compared(self.tolerance_m, self.tolerance_rad),
        )
        return Outcome("off", error.outputs, self._cause(because, ctx))

    async def _measured(self, ctx: Context, held: Pose) -> Pose:
        """Return where the platform is measured in the world; `held` is the pose of the tool in its frame."""
        if self.by == "cell":
            return (await ctx.call(ReadHexapod(pose=self.pose), to=self.device)).platform
        return compose_poses(await ctx.call(ForwardKinematics(), to=self.robot), invert_pose(held))

    async def _approach(self, ctx: Context, move: HexapodMove, start: Pose, held: Pose) -> Cause | None:
        """Move to the goal and correct; return why the arm did not move."""
        target = move.tool
        for _ in range(self.corrections + 1):
            duration_s = max(line_duration_s(start, target, speed_m_s=self.speed_m_s), _CORRECTION_S)
            line = CartLinTask(pose=target, duration_s=duration_s, collisions=CollisionOptions(may_touch=move.bodies))
            end = await ctx.perform(line, to=self.robot)
            if end.status != "succeeded":
                what = f"{self.robot} did not move the platform"
                return goal_cause(what, line, end, to=self.robot, where=ctx.path, kind=self.state_name)
            await ctx.clock.sleep(self.settle_s)
            measured = await self._measured(ctx, held)
            if HexapodError.between(measured, move.platform).within(self.tolerance_m / 5, self.tolerance_rad / 5):
                break
            nearer = interpolate_poses(measured, move.platform, _GAIN)
            start, target = target, compose_poses(compose_poses(nearer, invert_pose(measured)), target)
        return None

    async def _switch(self, ctx: Context, position: str) -> Cause | None:
        return await switch_brakes(ctx, self.device, position, kind=self.state_name)

    def _cause(self, because: Cause | None, ctx: Context) -> Cause:
        return wrap_cause(f"{self.device} was not moved to {self.pose}", because, where=ctx.path, kind=self.state_name)

    def _not(self, outcome: str, because: Cause | None, ctx: Context) -> Outcome:
        return Outcome(outcome, cause=self._cause(because, ctx))

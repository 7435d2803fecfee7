"""equipment.PullBase: an arm that holds an anchor pulls its own base along a passive linear unit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta
from msgspec.structs import replace

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import Cause, MeasuredValue, SkillFailed
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, interpolate_poses, invert_pose
from engine.skills import device_moves
from engine.skills.arm_control import ReadArm
from engine.skills.collision_options import CollisionOptions
from engine.skills.linear_units import BasePull, PlanBasePull, ReadLinearUnit
from engine.skills.motion import CartLinTask, ForwardKinematics, InverseKinematics
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.equipment.device_parameter_types import DeviceName
from states.equipment.linear_unit_types import (
    PlaceTolerance,
    UnitPlaceMetres,
    UnitPlaceName,
    compared_place,
    place_words,
    require_one_place,
)
from states.equipment.switch_brakes import switch_brakes
from states.motion.line_duration import line_duration_s
from states.motion.motion_target import RobotName

_CORRECTION_S = 0.5
# Friction holds back a carriage that went too far, by twice of it: each correction ends before the goal.
_GAIN = 0.9
# In so many steps the pull is tried beforehand; between two of them no joint may turn by more, in radians.
_STEPS, _TURN_RAD = 16, 0.7


class PullBase(State, frozen=True, kw_only=True):
    """Release the brakes, pull the base to a place by the anchor that the arm holds, and lock the brakes.

    `refused` before anything moves: the place is beyond the travel, the tool is at no anchor, the arm would not reach
    the anchor from there, or its load is too heavy. The tool moves on a line in the frame of the base, so that the
    base moves under it. The arm corrects what is measured, and the place is measured once more with locked brakes:
    `reached` within the tolerance, else `off`. Measured `by` the arm, the anchor stands still and the grip does not
    slip; by the scale of the unit, that tells. `drift_m` is how much it moved while the brakes were locked. A cancel
    leaves the brakes as they are; where the arm does not pull, they are locked.
    """

    state_name: ClassVar[str] = "equipment.PullBase"
    skills: ClassVar[Skills] = (device_moves.MoveDevice, CartLinTask)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "off", "refused", "brakes_failed", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)
    outputs: ClassVar[Mapping[str, Any]] = {"error_m": float, "drift_m": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("refused", "brakes_failed", "failed"), ("error_m", "drift_m")
    )

    robot: RobotName
    device: DeviceName
    place: UnitPlaceName = ""
    place_m: UnitPlaceMetres = None
    speed_m_s: Annotated[
        float, Meta(gt=0, le=0.25, description="Maximum speed of the base", extra_json_schema={"unit": "m/s"})
    ] = 0.1
    by: Annotated[Literal["arm", "scale"], Meta(description="What measures where the base is")] = "arm"
    settle_s: Annotated[
        float, Meta(ge=0, le=10, description="Time at rest before it is measured", extra_json_schema={"unit": "s"})
    ] = 0.5
    corrections: Annotated[int, Meta(ge=0, le=50, description="Maximum number of corrections")] = 10
    tolerance_m: PlaceTolerance = 0.001

    def __post_init__(self) -> None:
        require_one_place(self.place, self.place_m)

    def resources(self) -> tuple[str, ...]:
        """Return the arm and the device."""
        return (self.robot, self.device)

    async def run(self, ctx: Context) -> Outcome:
        """Plan, release, pull, correct, lock, measure."""
        try:
            tool = await ctx.call(ForwardKinematics(), to=self.robot)
            plan = PlanBasePull(place=self.place, place_m=self.place_m or 0.0, tool=tool)
            pull = await ctx.call(plan, to=self.device)
            refused = await self._refused(ctx, pull)
            if refused is not None:
                return self._not("refused", refused, ctx)
            fault = await self._switch(ctx, pull.released)
            if fault is not None:
                # Nobody knows what an output without its air has done.
                await self._switch(ctx, pull.locked)
                return self._not("brakes_failed", fault, ctx)
            stopped, before_m = await self._approach(ctx, pull)
            fault = await self._switch(ctx, pull.locked)
            if fault is not None or stopped is not None:
                return self._not("brakes_failed" if fault is not None else "failed", fault or stopped, ctx)
            await ctx.clock.sleep(self.settle_s)
            now_m = await self._measured_m(ctx, pull)
        except SkillFailed as error:
            return self._not("failed", cause_of(error), ctx)
        outputs = {"error_m": now_m - pull.goal_m, "drift_m": now_m - before_m}
        if abs(now_m - pull.goal_m) <= self.tolerance_m:
            return Outcome("reached", outputs)
        because = Cause(
            message=f"with locked brakes it is {1e3 * abs(now_m - pull.goal_m):.2f} mm away, measured by the {self.by}"
            f"; it moved by {1e3 * (now_m - before_m):.2f} mm while they were locked",
            where=f"{self.device}/{PlanBasePull.skill_name()}",
            compared=compared_place(now_m - pull.goal_m, self.tolerance_m),
        )
        return Outcome("off", outputs, self._cause(because, ctx))

    async def _refused(self, ctx: Context, pull: BasePull) -> Cause | None:
        """Return why the base must not be pulled."""
        where = f"{self.device}/{PlanBasePull.skill_name()}"
        if pull.refused:
            return Cause(message=pull.refused, where=where)
        if pull.robot != self.robot:
            return Cause(message=f"{pull.robot} stands on it, not {self.robot}", where=where)
        if self.by == "scale" and not pull.has_scale:
            return Cause(message="it has no scale: let the arm measure", where=where)
        carried_kg = (await ctx.call(ReadArm(), to=self.robot)).settings.load_kg
        if carried_kg > pull.carried_kg:
            over_kg = carried_kg - pull.carried_kg
            load = MeasuredValue(quantity="load", measured=carried_kg, unit="kg", most=pull.carried_kg)
            message = f"{self.robot} carries {over_kg:.2f} kg more than it may while it pulls"
            return Cause(message=message, where=where, compared=(load,))
        return await self._out_of_reach(ctx, pull)

    async def _out_of_reach(self, ctx: Context, pull: BasePull) -> Cause | None:
        """Return where on the line the arm would not reach the anchor, with the configuration before."""
        joints: tuple[float, ...] = ()
        for step in range(_STEPS + 1):
            share = step / _STEPS
            pose = replace(interpolate_poses(pull.start, pull.goal, share), frame=pull.start.frame)
            where = f"{self.robot}/{InverseKinematics.skill_name()}"
            at = f"{1e3 * (pull.start_m + share * (pull.goal_m - pull.start_m)):.0f} mm"
            words = f"with the joints [{', '.join(f'{q:.2f}' for q in joints)}] before"
            try:
                found = (await ctx.call(InverseKinematics(pose=pose, seed=joints), to=self.robot)).joints
            except SkillFailed as error:
                message = f"with its base at {at}, {self.robot} does not reach the anchor {pull.anchor}, {words}"
                return replace(wrap_cause(message, cause_of(error), where=where, kind=""), where=where)
            if joints and max(abs(one - other) for one, other in zip(found, joints, strict=True)) > _TURN_RAD:
                message = f"with its base at {at}, {self.robot} would have to reconfigure itself, {words}"
                return Cause(message=message, where=where)
            joints = found
        return None

    async def _measured_m(self, ctx: Context, pull: BasePull) -> float:
        """Return where the base is measured on its rail."""
        # Asked together: where the base is known to be does not count, only the joints of the arm.
        tool = await ctx.call(ForwardKinematics(), to=self.robot)
        reading = await ctx.call(ReadLinearUnit(place=self.place, place_m=self.place_m or 0.0), to=self.device)
        if self.by == "scale" and reading.scale_m is not None:
            return reading.scale_m
        held = compose_poses(invert_pose(reading.base), tool)
        back = zip(pull.start.xyz, held.xyz, pull.along, strict=True)
        return pull.start_m + sum((before - now) * along for before, now, along in back)

    async def _approach(self, ctx: Context, pull: BasePull) -> tuple[Cause | None, float]:
        """Pull to the goal and correct; return why the arm did not pull, and where the base is measured."""
        start, target, measured_m = pull.start, pull.goal, pull.start_m
        for _ in range(self.corrections + 1):
            stopped = await self._line(ctx, start, target)
            if stopped is not None:
                return stopped, measured_m
            await ctx.clock.sleep(self.settle_s)
            measured_m = await self._measured_m(ctx, pull)
            missing_m = pull.goal_m - measured_m
            if abs(missing_m) < self.tolerance_m / 5:
                break
            x, y, z = (at - _GAIN * missing_m * along for at, along in zip(target.xyz, pull.along, strict=True))
            start, target = target, replace(target, xyz=(x, y, z))
        return None, measured_m

    async def _line(self, ctx: Context, start: Pose, target: Pose) -> Cause | None:
        """Move the tool in the frame of the base; return why it did not."""
        duration_s = max(line_duration_s(start, target, speed_m_s=self.speed_m_s), _CORRECTION_S)
        # In the frame of the base nothing comes nearer to the arm but what it leaves: the path is not looked at.
        line = CartLinTask(pose=target, duration_s=duration_s, collisions=CollisionOptions(avoid=False))
        end = await ctx.perform(line, to=self.robot)
        if end.status == "succeeded":
            return None
        what = f"{self.robot} did not pull its base"
        return goal_cause(what, line, end, to=self.robot, where=ctx.path, kind=self.state_name)

    async def _switch(self, ctx: Context, position: str) -> Cause | None:
        return await switch_brakes(ctx, self.device, position, kind=self.state_name)

    def _cause(self, because: Cause | None, ctx: Context) -> Cause:
        what = f"{self.robot} was not pulled to {place_words(self.place, self.place_m)}"
        return wrap_cause(what, because, where=ctx.path, kind=self.state_name)

    def _not(self, outcome: str, because: Cause | None, ctx: Context) -> Outcome:
        return Outcome(outcome, cause=self._cause(because, ctx))

"""motion.PressAlongDmp: moves the tool along a Cartesian movement primitive under force control, and learns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from engine.errors import EntryNotFound
from engine.messages import Vector3
from engine.messages.primitives import CartOffsets, ForceReference
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.dmp import CartAdmitDMP, Compliance
from engine.skills.entries import ReadEntry, WriteEntry
from engine.skills.motion import CartTrapVel
from engine.state import Context, Outcome, Skills, State, goal_cause
from engine.store import decode_entry
from states.motion.motion_target import RobotName
from states.motion.primitive import ApproachSpeed, CartDmpEntry, TimeScale, resolve_cart_dmp

_KIND = "cart_offsets"


class PressAlongDmp(State, frozen=True, kw_only=True):
    """Move the tool along a Cartesian movement primitive and control the force on it by admittance.

    Each pass writes the learned offsets to the entry `learned` of kind `cart_offsets`; the next pass starts from them.
    """

    state_name: ClassVar[str] = "motion.PressAlongDmp"
    skills: ClassVar[Skills] = (CartTrapVel, CartAdmitDMP)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)
    outputs: ClassVar[Mapping[str, Any]] = {"force_error_rms_n": float, "force_error_max_n": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("force_error_rms_n", "force_error_max_n")}

    robot: RobotName
    dmp: Annotated[CartDmpEntry, Meta(description="`{entry: name}` of kind `cart_dmp`")]
    force_n: Annotated[
        Vector3,
        Meta(
            description="Desired force of the environment on the tool, task frame",
            extra_json_schema={"unit": "N", "measured_on": "wrench"},
        ),
    ]
    torque_nm: Annotated[Vector3, Meta(description="Desired torque, task frame", extra_json_schema={"unit": "N*m"})] = (
        0,
        0,
        0,
    )
    compliance: Annotated[Compliance, Meta(description="Compliance of the path to force errors, per axis")] = (
        Compliance()
    )
    slow_per_n: Annotated[float, Meta(ge=0, description="Slow-down of the motion per newton of force error")] = 0.0
    learned: Annotated[
        str,
        Meta(
            description="Entry of kind `cart_offsets` to read and write; empty for none",
            extra_json_schema={"new_entry": "cart_offsets"},
        ),
    ] = ""
    time_scale: TimeScale = 1.0
    approach_speed: ApproachSpeed = None
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Move to the start if `approach_speed` is given, press along the primitive, and store the learned offsets."""
        goal = await self._goal(ctx)
        if self.approach_speed is not None:
            approach = CartTrapVel(pose=goal.dmp.start, speed=self.approach_speed, collisions=self.collisions)
            end = await ctx.perform(approach, to=self.robot)
            if end.status != "succeeded":
                what = f"{self.robot} did not reach the start of cart_dmp entry {self.dmp.entry}"
                cause = goal_cause(what, approach, end, to=self.robot, where=ctx.path, kind=self.state_name)
                return Outcome("failed", cause=cause)
        end = await ctx.perform(goal, to=self.robot)
        if end.status != "succeeded" or end.result is None:
            what = f"{self.robot} did not press along cart_dmp entry {self.dmp.entry} to its end"
            cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
            return Outcome("failed", cause=cause)
        if self.learned and end.result.offsets is not None:
            value = msgspec.to_builtins(end.result.offsets)
            await ctx.call(WriteEntry(kind=_KIND, name=self.learned, value=value), to="store")
        errors = {
            "force_error_rms_n": end.result.force_error_rms_n,
            "force_error_max_n": end.result.force_error_max_n,
        }
        return Outcome("reached", errors)

    async def _goal(self, ctx: Context) -> CartAdmitDMP:
        return CartAdmitDMP(
            dmp=await resolve_cart_dmp(ctx, self.dmp, time_scale=self.time_scale),
            offsets=await self._offsets(ctx),
            force=ForceReference.constant(force_n=self.force_n, torque_nm=self.torque_nm),
            compliance=self.compliance,
            slow_per_n=self.slow_per_n,
            collisions=self.collisions,
        )

    async def _offsets(self, ctx: Context) -> CartOffsets | None:
        if not self.learned:
            return None
        try:
            return decode_entry(await ctx.call(ReadEntry(kind=_KIND, name=self.learned), to="store"), CartOffsets)
        except EntryNotFound:
            # Nothing is learned before the first pass.
            return None

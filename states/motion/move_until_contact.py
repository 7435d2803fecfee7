"""motion.MoveUntilContact: moves the tool on a straight line until contact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.messages import Vector3
from engine.skills import contact
from engine.skills.axes import Axes
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.contact import (
    RIGID_N_M,
    ApproachSpeed,
    ClearDistance,
    ContactForce,
    MaxDistance,
    PeakForce,
    SurfaceStiffness,
)
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName


class MoveUntilContact(State, frozen=True, kw_only=True):
    """Move the tool along `direction` until the contact force reaches `force_n`.

    `no_contact` when there is no contact within `distance_m`. Writes the travelled distance, the force at its end and
    the greatest one. With `peak_n` the tool slows down after `clear_m`.
    """

    state_name: ClassVar[str] = "motion.MoveUntilContact"
    skills: ClassVar[Skills] = (contact.MoveUntilContact,)
    outcomes: ClassVar[tuple[str, ...]] = ("contact", "no_contact", "failed")
    success: ClassVar[tuple[str, ...]] = ("contact",)
    outputs: ClassVar[Mapping[str, Any]] = {"travelled_m": float, "force_n": float, "peak_n": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("travelled_m", "force_n", "peak_n")}

    robot: RobotName
    direction: Annotated[Vector3, Meta(description="Direction of motion; `[0, 0, -1]` is down in the world frame")]
    distance_m: MaxDistance
    frame: Axes = "world"
    speed_m_s: ApproachSpeed = 0.02
    force_n: ContactForce = 10.0
    peak_n: PeakForce | None = None
    clear_m: ClearDistance = 0.0
    surface_n_m: SurfaceStiffness = RIGID_N_M
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        goal = contact.MoveUntilContact(
            direction=self.direction,
            distance_m=self.distance_m,
            frame=self.frame,
            speed_m_s=self.speed_m_s,
            force_n=self.force_n,
            peak_n=self.peak_n,
            clear_m=self.clear_m,
            surface_n_m=self.surface_n_m,
            collisions=self.collisions,
        )
        end = await ctx.perform(goal, to=self.robot)
        what = f"{self.robot} detected no contact within {self.distance_m:.3f} m"
        if end.status != "succeeded" or end.result is None:
            cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
            return Outcome("failed", cause=cause)
        measured = end.result
        outputs = {"travelled_m": measured.travelled_m, "force_n": measured.force_n, "peak_n": measured.peak_n}
        if end.result.contact:
            return Outcome("contact", outputs)
        because = Cause(
            message=f"the contact force at the end was {end.result.force_n:.1f} N, threshold {self.force_n:.1f} N",
            where=f"{self.robot}/{goal.skill_name()}",
        )
        return Outcome("no_contact", outputs, wrap_cause(what, because, where=ctx.path, kind=self.state_name))

"""motion.IdentifyPayload: weighs what an arm carries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.messages import Vector3
from engine.skills import identification
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.identification import PayloadAmplitude
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName


class IdentifyPayload(State, frozen=True, kw_only=True):
    """Weigh what the arm carries: its last three joints swing about the start and end there.

    Nothing may touch the tool or the part meanwhile. Writes mass and centre of mass as `motion.SetLoad` takes them, and
    their uncertainties, two standard deviations. `uncertain` where that of the mass exceeds `tolerance_kg`.
    """

    state_name: ClassVar[str] = "motion.IdentifyPayload"
    skills: ClassVar[Skills] = (identification.IdentifyPayload,)
    outcomes: ClassVar[tuple[str, ...]] = ("identified", "uncertain", "failed")
    success: ClassVar[tuple[str, ...]] = ("identified",)
    outputs: ClassVar[Mapping[str, Any]] = {
        "mass_kg": float,
        "com_m": Vector3,
        "mass_uncertainty_kg": float,
        "com_uncertainty_m": float,
    }
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "failed": ("mass_kg", "com_m", "mass_uncertainty_kg", "com_uncertainty_m")
    }

    robot: RobotName
    amplitude_rad: PayloadAmplitude = 0.5
    tolerance_kg: Annotated[
        float, Meta(gt=0.0, description="Maximum uncertainty of the mass", extra_json_schema={"unit": "kg"})
    ] = 0.1
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and compare the uncertainty of its result."""
        goal = identification.IdentifyPayload(amplitude_rad=self.amplitude_rad, collisions=self.collisions)
        end = await ctx.perform(goal, to=self.robot)
        what = f"{self.robot} did not identify its payload"
        if end.status != "succeeded" or end.result is None:
            cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
            return Outcome("failed", cause=cause)
        found = end.result
        outputs: dict[str, object] = {
            "mass_kg": found.mass_kg,
            "com_m": found.com_m,
            "mass_uncertainty_kg": found.mass_uncertainty_kg,
            "com_uncertainty_m": found.com_uncertainty_m,
        }
        if found.mass_uncertainty_kg <= self.tolerance_kg:
            return Outcome("identified", outputs)
        because = Cause(
            message=f"the mass is {found.mass_kg:.2f} kg ± {found.mass_uncertainty_kg:.2f} kg,"
            f" tolerance {self.tolerance_kg:.2f} kg",
            where=f"{self.robot}/{goal.skill_name()}",
        )
        return Outcome("uncertain", outputs, wrap_cause(what, because, where=ctx.path, kind=self.state_name))

"""motion.IdentifyFriction: measures the friction of an arm's joints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.skills import identification
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.identification import FrictionAmplitude, JointFrictionEstimate
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName


class IdentifyFriction(State, frozen=True, kw_only=True):
    """Measure Coulomb and viscous friction of joints: each in turn swings about the start and ends there.

    Writes one estimate per joint with its uncertainty; `coulomb_nm` and `viscous_nms_rad` are those of `robot.yaml`.
    """

    state_name: ClassVar[str] = "motion.IdentifyFriction"
    skills: ClassVar[Skills] = (identification.IdentifyFriction,)
    outcomes: ClassVar[tuple[str, ...]] = ("identified", "failed")
    success: ClassVar[tuple[str, ...]] = ("identified",)
    outputs: ClassVar[Mapping[str, Any]] = {"friction": tuple[JointFrictionEstimate, ...]}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("friction",)}

    robot: RobotName
    joints: Annotated[tuple[str, ...], Meta(description="Joints to measure; empty for all")] = ()
    amplitude_rad: FrictionAmplitude = 0.4
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end."""
        goal = identification.IdentifyFriction(
            joints=self.joints, amplitude_rad=self.amplitude_rad, collisions=self.collisions
        )
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded" and end.result is not None:
            return Outcome("identified", {"friction": end.result.joints})
        what = f"{self.robot} did not identify its friction"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

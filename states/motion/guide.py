"""motion.Guide: lets a person guide an arm by hand and records the trajectory."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.guiding import DampingShare, GuideArm, GuideDuration, SamplePeriod
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName


class Guide(State, frozen=True, kw_only=True):
    """Make the arm compliant for hand guiding until `<robot>/finish_guiding` is called, or for `duration_s`.

    With `record` the trajectory is written to the store as a `trajectory` entry of that name. Writes the number of
    samples, 0 without a record.
    """

    state_name: ClassVar[str] = "motion.Guide"
    skills: ClassVar[Skills] = (GuideArm,)
    outcomes: ClassVar[tuple[str, ...]] = ("finished", "failed")
    success: ClassVar[tuple[str, ...]] = ("finished",)
    outputs: ClassVar[Mapping[str, Any]] = {"samples": int}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("samples",)}

    robot: RobotName
    duration_s: GuideDuration | None = None
    record: Annotated[
        str,
        Meta(
            description="Name of the entry to write; empty records nothing",
            extra_json_schema={"new_entry": "trajectory"},
        ),
    ] = ""
    sample_s: SamplePeriod = 0.01
    damping: DampingShare = 0.1
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and wait until the arm holds its position again."""
        goal = GuideArm(
            damping=self.damping,
            duration_s=self.duration_s,
            record=self.record,
            sample_s=self.sample_s,
            collisions=self.collisions,
        )
        end = await ctx.perform(goal, to=self.robot)
        if end.status == "succeeded" and end.result is not None:
            return Outcome("finished", {"samples": end.result.samples})
        what = f"{self.robot} did not finish guiding"
        cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
        return Outcome("failed", cause=cause)

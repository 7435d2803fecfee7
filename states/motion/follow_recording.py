"""motion.FollowRecording: moves an arm along a recorded motion."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec
from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import SkillFailed
from engine.skills.collision_options import CollisionOptions, PathCollisions
from engine.skills.dmp import JointDMP, LearnJointDmp
from engine.skills.motion import JointTrapVel
from engine.state import Context, Outcome, Skills, State, goal_cause
from states.motion.motion_target import RobotName
from states.motion.primitive import ApproachSpeed, RecordingEntry, TimeScale


class FollowRecording(State, frozen=True, kw_only=True):
    """Move an arm along a recorded motion: learn a joint-space movement primitive from it and follow that.

    The recording is read when the state runs: a new recording of the same name changes the next run.
    """

    state_name: ClassVar[str] = "motion.FollowRecording"
    skills: ClassVar[Skills] = (JointTrapVel, JointDMP)
    outcomes: ClassVar[tuple[str, ...]] = ("reached", "failed")
    success: ClassVar[tuple[str, ...]] = ("reached",)

    robot: RobotName
    recording: Annotated[RecordingEntry, Meta(description="`{entry: name}` of kind `trajectory`")]
    time_scale: TimeScale = 1.0
    approach_speed: ApproachSpeed = None
    collisions: PathCollisions = CollisionOptions()

    def resources(self) -> tuple[str, ...]:
        """Return the arm."""
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        """Learn, move to the start if `approach_speed` is given, follow, and return the outcome."""
        name = self.recording.entry
        try:
            learned = await ctx.call(LearnJointDmp(entry=name), to=self.robot)
        except SkillFailed as error:
            what = f"no movement primitive was learned from trajectory entry {name}"
            return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=self.state_name))
        dmp = msgspec.structs.replace(learned.dmp, tau=learned.dmp.tau * self.time_scale)
        follow = JointDMP(dmp=dmp, collisions=self.collisions)
        goals: list[tuple[str, JointTrapVel | JointDMP]] = [
            (f"{self.robot} did not follow trajectory entry {name} to its end", follow)
        ]
        if self.approach_speed is not None:
            approach = JointTrapVel(joints=dmp.start, speed=self.approach_speed, collisions=self.collisions)
            goals.insert(0, (f"{self.robot} did not reach the start of trajectory entry {name}", approach))
        for what, goal in goals:
            end = await ctx.perform(goal, to=self.robot)
            if end.status != "succeeded":
                cause = goal_cause(what, goal, end, to=self.robot, where=ctx.path, kind=self.state_name)
                return Outcome("failed", cause=cause)
        return Outcome("reached")

"""motion.ReadPose: reads the measured pose of an arm."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import SkillFailed
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.skills.arm_control import ReadArm
from engine.skills.motion import ForwardKinematics
from engine.state import Context, Outcome, State, nothing_to_undo
from states.motion.motion_target import RobotName


class ReadPose(State, frozen=True, kw_only=True):
    """Read the measured pose, in the world, of the tool centre point or of the tool link of the model.

    The tool link is the flange of an arm without a tool; its pose does not depend on the tool centre point that is set.
    """

    state_name: ClassVar[str] = "motion.ReadPose"
    outcomes: ClassVar[tuple[str, ...]] = ("read", "failed")
    success: ClassVar[tuple[str, ...]] = ("read",)
    outputs: ClassVar[Mapping[str, Any]] = {"pose": Pose}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("pose",)}
    undo = nothing_to_undo

    robot: RobotName
    of: Annotated[
        Literal["tool_centre_point", "tool_link"], Meta(description="Whose pose: of the tool centre point or the link")
    ] = "tool_centre_point"

    async def run(self, ctx: Context) -> Outcome:
        """Call the services of the arm that read."""
        try:
            pose = await ctx.call(ForwardKinematics(), to=self.robot)
            if self.of == "tool_link":
                settings = (await ctx.call(ReadArm(), to=self.robot)).settings
                tip = Pose(xyz=settings.tool_xyz_m, xyzw=settings.tool_xyzw)
                pose = compose_poses(pose, invert_pose(tip))
        except SkillFailed as error:
            message = f"the pose of {self.robot} was not read"
            return Outcome("failed", cause=wrap_cause(message, cause_of(error), where=ctx.path, kind=self.state_name))
        return Outcome("read", {"pose": pose})

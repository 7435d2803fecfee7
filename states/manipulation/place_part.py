"""manipulation.PlacePart: puts down the part that an arm holds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from msgspec import Meta

from engine.event import Cause
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.skills.motion import ForwardKinematics, Speed
from engine.skills.planning import BlockedPathTimeout, Margin
from engine.skills.planning_scene import CONTACT_M, TouchingPair
from engine.state import Context, Outcome, State
from states.frames import frame_in_world, part_in_world
from states.manipulation.approach import Approach
from states.manipulation.approach_line import ApproachDirection, LineLength, LineSpeed, retreat_vector
from states.manipulation.step_sequence import SequenceEnd, SequenceStep, run_steps
from states.manipulation.tool_states import ToolKind, check_held_state, release_state, tool_resource
from states.motion.motion_target import NO_OFFSET, RobotName, ShownPoseTarget, resolve_pose
from states.motion.set_load import SetLoad
from states.scene.detach import Detach
from states.scene.scene_parameter_types import PartName

_FAILED = {"failed": "failed"}


class PlacePart(State, frozen=True, kw_only=True):
    """Move free of collisions over the place, straight down, open the tool, and straight back.

    With `target_of: part` the part itself comes to stand at the target, however the tool holds it. It may touch what
    it is put down on over the last 5 mm of its way; where it would come deeper, or touch anything before, it is
    `blocked` with both names before that. `missed` when the part was lost on the way, `unreachable` and `blocked` as
    in `manipulation.PickPart`; then the arm still holds it. The arm knows of no load afterwards.
    """

    state_name: ClassVar[str] = "manipulation.PlacePart"
    outcomes: ClassVar[tuple[str, ...]] = ("placed", "missed", "unreachable", "blocked", "failed")
    success: ClassVar[tuple[str, ...]] = ("placed",)
    outputs: ClassVar[Mapping[str, Any]] = {"reason": str}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"placed": ("reason",)}

    robot: RobotName
    part: PartName
    target: Annotated[ShownPoseTarget, Meta(description="Where to: `{xyz, xyzw, frame}`, or `{entry: name}`")]
    target_of: Annotated[
        Literal["tool", "part"], Meta(description="What comes to stand at `target`: tool centre point or part")
    ] = "tool"
    tool: ToolKind = "gripper"
    approach: ApproachDirection = None
    approach_m: LineLength = 0.1
    speed: Speed = 0.3
    line_speed_m_s: LineSpeed = 0.1
    margin_m: Margin = 0.0
    patience_s: BlockedPathTimeout = 60.0

    def __post_init__(self) -> None:
        if self.approach is not None and not any(self.approach):
            raise ValueError("`approach` is no direction")

    def resources(self) -> tuple[str, ...]:
        """The arm and its tool."""
        return (self.robot, tool_resource(self.robot, self.tool))

    async def run(self, ctx: Context) -> Outcome:
        """Go through the placing."""
        ended = await self._place(ctx)
        if ended is None:
            return Outcome("placed")
        return ended.under(f"{self.robot} did not place part {self.part}", where=ctx.path, kind=self.state_name)

    async def _place(self, ctx: Context) -> SequenceEnd | None:
        held = [SequenceStep(check_held_state(self.robot, self.tool, self.part), {"lost": "missed"})]
        if ended := await run_steps(ctx, held):
            return ended
        target = await self._tool_place(ctx)
        if isinstance(target, Cause):
            return SequenceEnd("missed", target)
        frame, place = target
        approach = self._approach(retreat_vector(place, frame, self.approach, self.approach_m))
        found = await approach.to(ctx, [place], before=held)
        if isinstance(found, SequenceEnd):
            return found
        return await run_steps(ctx, self._letting_go()) or await approach.straight_out(ctx, place)

    async def _tool_place(self, ctx: Context) -> tuple[Pose, Pose] | Cause:
        """Return the frame that the target is given in, and the pose of the tool there, both in the world."""
        given = await resolve_pose(ctx, self.target, NO_OFFSET)
        frame = await frame_in_world(ctx, given.frame)
        target = compose_poses(frame, given)
        if self.target_of == "tool":
            return frame, target
        part = await part_in_world(ctx, self.part)
        if isinstance(part, Cause):
            return part
        tool = await ctx.call(ForwardKinematics(), to=self.robot)
        return frame, compose_poses(target, compose_poses(invert_pose(part), tool))

    def _approach(self, out_m: Vector3) -> Approach:
        return Approach(
            robot=self.robot,
            out_m=out_m,
            onward_m=out_m,
            speed=self.speed,
            line_speed_m_s=self.line_speed_m_s,
            margin_m=self.margin_m,
            patience_s=self.patience_s,
            expected=self._stands_on,
            kind=self.state_name,
        )

    def _stands_on(self, pair: TouchingPair) -> bool:
        """Tell whether a pair is the part and what it stands on: no link of an arm, and no deeper than contact is."""
        other = pair.second if pair.first == self.part else pair.first
        return self.part in (pair.first, pair.second) and "/" not in other and pair.depth_m <= CONTACT_M

    def _letting_go(self) -> list[SequenceStep]:
        return [
            SequenceStep(release_state(self.robot, self.tool, self.part), _FAILED),
            SequenceStep(Detach(part=self.part), _FAILED),
            SequenceStep(SetLoad(robot=self.robot, mass_kg=0.0), _FAILED),
        ]
